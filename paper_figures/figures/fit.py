"""The material that k_stretch corresponds to: Young's modulus of the elastic bar that sags as PBS does, over k_stretch, for several
iteration counts and meshes; and the smallest distance to PBS in twist and bend that any Poisson's ratio achieves."""
import records
from drawing import style
from records import entries

sag_columns = {"vertices", "k_stretch", "k_volume", "iterations", "young_pa", "settled"}
valley_columns = {"model", "element_order", "attachment", "body", "k_stretch", "poisson", "misfit_pct"}
looks = {"0.05": (style.sky, "o"), "0.2": (style.blue, "v"), "0.9": (style.vermillion, "s")}
lines = {"pbs": "-", "pbs_converged": (0, (4, 1.5))}
names = {"pbs": "24 iterations", "pbs_converged": "converged"}


def draw_young(axes, rows):
    """One line per mesh and number of iterations, with the volume constraints on."""
    rows = [row for row in rows if float(row["k_volume"]) == 1.0 and float(row["settled"]) == 1.0]
    meshes = sorted({int(row["vertices"]) for row in rows})
    for vertices, line in zip(meshes, ("-", (0, (4, 1.5)), (0, (1, 1)))):
        counts = sorted({int(row["iterations"]) for row in rows})
        for iterations, (color, marker) in zip(counts, style.sequence):
            chosen = [row for row in rows if int(row["vertices"]) == vertices and int(row["iterations"]) == iterations]
            axes.plot([float(row["k_stretch"]) for row in chosen], [float(row["young_pa"]) / 1e3 for row in chosen], color=color,
                      marker=marker, linestyle=line, label=f"{iterations} iterations, {vertices} vertices")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("k_stretch [1]")
    axes.set_ylabel("Young's modulus [kPa]")
    axes.set_title("by sag: k_volume 1, time step 10 ms, 1000 kg/m\u00b3")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=2, fontsize=6, handlelength=3.4)
    return [{"shown": "young_kpa", "of": f"{row['vertices']} vertices, {row['iterations']} iterations", "at": row["k_stretch"],
             "value": float(row["young_pa"]) / 1e3} for row in rows]


def draw_valley(axes, rows):
    """Neo-Hookean P2 held by the smooth attachment; if that is not on record, the first reference."""
    wanted = [row for row in rows if (row["model"], row["element_order"], row["attachment"]) == ("neo_hookean", "2", "smooth")]
    first = rows[0]
    chosen = wanted or [row for row in rows if all(row[key] == first[key] for key in ("model", "element_order", "attachment"))]
    for body, line in lines.items():
        for k_stretch, (color, marker) in looks.items():
            valley = [row for row in chosen if row["body"] == body and float(row["k_stretch"]) == float(k_stretch)]
            axes.plot([float(row["poisson"]) for row in valley], [float(row["misfit_pct"]) for row in valley], color=color, linestyle=line,
                      marker=marker, markevery=5, label=f"k_stretch {k_stretch}, {names[body]}")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("Poisson's ratio of the finite elements [1]")
    axes.set_ylabel("distance to PBS at the joint [%]")
    axes.set_title("twist and bend, 30\u00b0 to 90\u00b0")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncol=2, fontsize=6, handlelength=3.4)
    return [{"shown": "misfit_pct", "of": f"{row['body']}, k_stretch {row['k_stretch']}", "at": row["poisson"], "value": row["misfit_pct"]}
            for row in chosen]


def fit(results, figures):
    folder = results / "fit"
    figure, axes = style.panels(1, 2, height_in=3.1)
    behind = draw_young(axes[0][0], records.table(folder / "sag.csv", sag_columns))
    behind += draw_valley(axes[0][1], records.table(folder / "valley.csv", valley_columns))
    style.save(figure, figures / "fit", entries.origin_of(results, "fit"), behind)
