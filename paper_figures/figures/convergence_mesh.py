"""PBS from LBS on a sequence of meshes of one limb, twisted and bent by 90 degrees, after 24 iterations (filled) and after the last
(hollow). The panels show the residual of the constraints, the volume change per tet, the distance of the joint from the finite elements,
and the iterations until volumes are kept within 0.5 %. The comparison shows whether 24 iterations achieve the same on fine meshes as on
coarse ones."""
import math

import records
from drawing import style
from records import entries
from words.number_words import figure, span

ladders = {"ladder_twist": "twist 90\u00b0", "ladder_bend": "bend 90\u00b0"}
panels = [("residual_24", "last_residual", "combined residual [1]"),
          ("volume_abs_change_24_pct", "last_volume_abs_change_pct", "absolute volume\nchange [%]"),
          ("error_24_pct", "last_error_pct", "error at the joint [%]")]
columns = {"vertices", "order", "precision", "k_stretch", "start", "iterations", "iterations_to_volume", "volume_reached",
           *(column for early, late, _ in panels for column in (early, late))}


def of_ladder(file):
    rows = [row for row in records.table(file, columns) if (row["order"], row["precision"], row["start"]) == ("ordered", "f32", "lbs")
            and float(row["k_stretch"]) == 0.2]
    if not rows:
        raise records.RecordsMissing(f"{file}: no rows of ordered f32 from LBS with k_stretch 0.2")
    return sorted(rows, key=lambda row: int(row["vertices"]))


def draw_measure(axes, rows, name, number, early, late):
    """Where no reference was computed for a mesh, the panel states that."""
    if not any(is_measured(row, early) for row in rows):
        axes.annotate(f"{name}: no reference on record", (0.5, 0.5 + 0.1 * number), xycoords="axes fraction", ha="center", fontsize=6)
        return
    last = f"{name}, {int(rows[0]['iterations']):,} iterations"
    for column, label, look in ((early, f"{name}, 24 iterations", {}), (late, last, {"markerfacecolor": "white", "linewidth": 0.7})):
        measured = [row for row in rows if is_measured(row, column)]
        if measured:
            style.draw_series(axes, number, records.numbers(measured, "vertices"), records.numbers(measured, column), label, **look)
    axes.set_yscale("log")


def is_measured(row, column):
    return not math.isnan(float(row[column] or "nan"))


def draw_iterations(axes, rows, name, number):
    """A caret marks a mesh whose tolerance was not reached at the last iteration."""
    color, marker = style.sequence[number]
    vertices, iterations = records.numbers(rows, "vertices"), records.numbers(rows, "iterations_to_volume")
    axes.plot(vertices, iterations, color=color, linestyle=style.lines[number], linewidth=0.7)
    for reached in (True, False):
        shown = [place for place, row in zip(zip(vertices, iterations), rows) if (float(row["volume_reached"]) == 1.0) == reached]
        if shown:
            axes.plot(*zip(*shown), color=color, marker=marker if reached else 6, linestyle="none",
                      markersize=4 if reached else 8 - 3 * number, label=f"{name}, reached" if reached else f"{name}, not reached")


def draw_band(axes):
    """A band that reaches down to the axis."""
    low, high = axes.get_ylim()
    axes.axhspan(min(low, 0.4), 0.5, color="#E8E8E8", linewidth=0, zorder=0, label="within 0.5 %")
    axes.set_ylim(min(low, 0.4), high)


def convergence_mesh_facts(rows):
    """The residuals of the coarsest and the finest mesh of each sequence, and how many meshes keep volumes within 0.5 %."""
    vertices = [int(row["vertices"]) for row in rows]
    told = {"vertices": span(vertices), "last": rows[0]["iterations"]}
    for ladder in ladders:
        shown = sorted((row for row in rows if row["ladder"] == ladder), key=lambda row: int(row["vertices"]))
        name, ends = ladder.removeprefix("ladder_"), (shown[0], shown[-1])
        for column, of in (("residual_24", "residual"), ("last_residual", "last_residual"), ("volume_abs_change_24_pct", "volume"),
                           ("last_volume_abs_change_pct", "last_volume")):
            told[f"{name}_{of}"] = " and ".join(figure(float(row[column])) for row in ends)
        told[f"{name}_reached"] = f"{sum(float(row['volume_reached']) == 1.0 for row in shown)} of {len(shown)}"
        told[f"{name}_error"] = errors_of([row for row in shown if is_measured(row, "error_24_pct")])
    return told


def errors_of(measured):
    """The errors of the coarsest and the finest mesh that have a reference, early and late."""
    if not measured:
        return "no reference on record"
    ends = measured[:1] if len(measured) == 1 else [measured[0], measured[-1]]
    return ", ".join(f"{figure(float(row['error_24_pct']))} % after 24 and {figure(float(row['last_error_pct']))} % after "
                     f"{row['iterations']} on {row['vertices']} vertices" for row in ends)


def convergence_mesh(results, figures):
    folder = results / "convergence"
    drawing, axes = style.panels(2, 2, height_in=1.75, sharex=True)
    behind = []
    for number, (ladder, name) in enumerate(ladders.items()):
        rows = of_ladder(folder / ladder / "rates.csv")
        for panel, (early, late, label) in zip(axes.flat, panels):
            draw_measure(panel, rows, name, number, early, late)
            panel.set_ylabel(label)
        draw_iterations(axes[1][1], rows, name, number)
        behind += [{"ladder": ladder} | {column: row[column] for column in sorted(columns)} for row in rows]
    axes[1][1].set_ylabel("iterations until 0.5 %\nvolume change")
    for panel in axes.flat:
        low, high = panel.get_ylim()
        style.log_scale(panel.yaxis, steps=(1, 2, 5) if high > 5 * low else (1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 7))
    draw_band(axes[0][1])
    for panel in axes[1]:
        style.decades(panel.xaxis)
        panel.set_xlabel("vertices of the limb")
    style.legend_above(drawing, columns=4)
    style.save(drawing, figures / "convergence_mesh", entries.origin_of(results, "convergence_mesh"), behind)
