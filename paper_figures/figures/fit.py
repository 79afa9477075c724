"""The material that k_stretch corresponds to: Young's modulus of the elastic bar that sags as PBS does, over k_stretch, for several
iteration counts and meshes."""
import records
from drawing import style
from records import entries

sag_columns = {"vertices", "k_stretch", "k_volume", "iterations", "young_pa", "settled"}


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


def fit(results, figures):
    folder = results / "fit"
    figure, axes = style.panels(1, 1, height_in=3.1)
    behind = draw_young(axes[0][0], records.table(folder / "sag.csv", sag_columns))
    style.save(figure, figures / "fit", entries.origin_of(results, "fit"), behind)
