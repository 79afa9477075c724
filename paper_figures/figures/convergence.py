"""The figures of the study of convergence: PBS over 1,000 iterations from four initial guesses, and from LBS on a
sequence of meshes."""
import math

import records
from drawing import style
from words.number_words import span

# The upper panels show the residual of the constraints, the lower ones the distance to the finite element reference.
# The error does not follow the residual: in the twist it grows again while PBS converges to a different shape. Starting
# from the previous frame or the rest pose, PBS has no information about the twist of a limb, so the residual is small
# and the error large.

cases = [("limb_twist", "twist_90", "limb, twist 90\u00b0"), ("limb_bend", "bend_60", "limb, bend 60\u00b0"),
         ("human", "01_01_crouch", "human, crouch")]
starts = {"lbs": "from LBS (the paper)", "previous_frame": "from the previous frame", "rest_pose": "from the rest pose",
          "rigid_bind": "from the nearest bone, rigidly"}
measures = [("residuals.csv", "combined", "combined residual [1]", (5e-3, 5.0)),
            ("towards.csv", "error_joint_pct", "error at the joints [%]", (0.5, 600.0))]
setting = {"order", "precision", "k_stretch", "start"}


def of_default(rows, start, missing):
    """The rows in the default order and stiffness from this initial guess."""
    rows = [row for row in rows if (row["order"], row["precision"], row["start"]) == ("ordered", "f32", start)
            and float(row["k_stretch"]) == 0.2]
    records.need(rows, missing)
    return rows


def draw_case(axes, file, column, limits, pose):
    behind = []
    for number, (start, label) in enumerate(starts.items()):
        rows = [row for row in records.table(file, {"pose", "iteration", column} | setting) if row["pose"] == pose]
        rows = of_default(rows, start, f"{file}: no rows of {pose}, ordered f32, k_stretch 0.2, start {start}")
        style.draw_series(axes, number, rows, "iteration", column, label=label)
        behind += [{"case": file.parent.name, "pose": pose, "start": start, "measure": column, "iteration": i,
                    "value": v}
                   for i, v in zip(records.numbers(rows, "iteration"), records.numbers(rows, column))]
    axes.set_xscale("symlog", linthresh=1, linscale=0.4)
    axes.set_xticks([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1000"])
    axes.axvline(24, color=style.ink, linewidth=0.6)
    axes.set(xlim=(0, 1100), yscale="log", ylim=limits)
    most = {label: max(row["value"] for row in behind if row["start"] == start) for start, label in starts.items()}
    # These lie below the panel.
    below = [f"{label}: below $10^{{{math.ceil(math.log10(value))}}}$"
             for label, value in most.items() if value < limits[0]]
    style.name_area(axes, "\n".join(below), (0.97, limits[1]), ha="right", va="top",
                    bbox={"color": "white", "pad": 1.0})
    return behind


def convergence_iterations(results):
    drawing, axes = style.panels(2, 3, height_in=1.9, sharex="col", sharey="row")
    behind = []
    for panels, (case, pose, _) in zip(axes.T, cases):
        for panel, (table, measure, _, limits) in zip(panels, measures):
            behind += draw_case(panel, results / "convergence" / case / table, measure, limits, pose)
    style.label(axes, [title for *_, title in cases], [label for _, _, label, _ in measures],
                ["iterations; line: the paper's 24"] * 3)
    style.log_scale(axes[1][0].yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500])
    style.log_scale(axes[0][0].yaxis, [0.01, 0.1, 1])
    style.key_below(drawing)
    return drawing, behind


# PBS from LBS on a sequence of meshes of one limb, twisted and bent by 90 degrees, after 24 iterations (filled) and
# after the last (hollow): the residual of the constraints, the volume change per tet, the distance of the joint from
# the finite elements, and the iterations until volumes are kept within 0.5 %. This shows whether 24 iterations achieve
# the same on fine meshes as on coarse ones.

ladders = {"ladder_twist": "twist 90\u00b0", "ladder_bend": "bend 90\u00b0"}
of_panels = [("residual_24", "last_residual", "combined residual [1]"),
             ("volume_abs_change_24_pct", "last_volume_abs_change_pct", "absolute volume\nchange [%]"),
             ("error_24_pct", "last_error_pct", "error at the joint [%]")]
columns = setting | {"vertices", "iterations", "iterations_to_volume", "volume_reached",
                     *(column for early, late, _ in of_panels for column in (early, late))}


def draw_measure(axes, rows, name, number, early, late):
    """Where no reference was computed for a mesh, the panel states that."""
    if not any(is_measured(row, early) for row in rows):
        axes.annotate(f"{name}: no reference on record", (0.5, 0.5 + 0.1 * number), xycoords="axes fraction",
                      ha="center")
        return
    for column, iterations, look in ((early, 24, {}), (late, int(rows[0]["iterations"]),
                                                       {"markerfacecolor": "white", "linewidth": 0.7})):
        measured = [row for row in rows if is_measured(row, column)]
        if measured:
            style.draw_series(axes, number, measured, "vertices", column, label=f"{name}, {iterations:,} iterations",
                              **look)
    axes.set_yscale("log")


def is_measured(row, column):
    return not math.isnan(float(row[column] or "nan"))


def draw_iterations(axes, rows, name, number):
    """A caret marks a mesh whose tolerance was not reached at the last iteration."""
    color, marker = style.sequence[number]
    axes.set_yscale("log")
    style.plot(axes, rows, "vertices", "iterations_to_volume", color=color, linestyle=style.lines[number],
               linewidth=0.7)
    for reached, words in ((True, "reached"), (False, "not reached")):
        shown = [row for row in rows if (float(row["volume_reached"]) == 1.0) == reached]
        if shown:
            style.plot(axes, shown, "vertices", "iterations_to_volume", color=color, marker=marker if reached else 6,
                       linestyle="none", markersize=4 if reached else 8 - 3 * number, label=f"{name}, {words}")


def convergence_mesh_facts(rows):
    """The sizes of the meshes, the last iteration, and how many meshes of each sequence keep volumes within 0.5 %."""
    facts = {"vertices": span([int(row["vertices"]) for row in rows]), "last": rows[0]["iterations"]}
    for ladder in ladders:
        reached = [float(row["volume_reached"]) == 1.0 for row in rows if row["ladder"] == ladder]
        facts[f"{ladder.removeprefix('ladder_')}_reached"] = f"{sum(reached)} of {len(reached)}"
    return facts


def convergence_mesh(results):
    drawing, axes = style.panels(2, 2, height_in=1.75, sharex=True)
    behind = []
    for number, (ladder, name) in enumerate(ladders.items()):
        file = results / "convergence" / ladder / "rates.csv"
        rows = of_default(records.table(file, columns), "lbs", f"{file}: no rows of ordered f32 from LBS with "
                                                               "k_stretch 0.2")
        rows.sort(key=lambda row: int(row["vertices"]))
        for panel, (early, late, label) in zip(axes.flat, of_panels):
            draw_measure(panel, rows, name, number, early, late)
            panel.set_ylabel(label)
        draw_iterations(axes[1][1], rows, name, number)
        behind += style.taken(rows, sorted(columns), ladder=ladder)
    axes[1][1].set_ylabel("iterations until 0.5 %\nvolume change")
    for panel in axes.flat:
        low, high = panel.get_ylim()
        style.log_scale(panel.yaxis, steps=(1, 2, 5) if high > 5 * low else (1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 7))
    low, high = axes[0][1].get_ylim()  # the band reaches down to the axis
    axes[0][1].axhspan(min(low, 0.4), 0.5, color=style.pale, linewidth=0, zorder=0)
    style.name_area(axes[0][1], "within 0.5 %", (0.01, min(low, 0.4)), va="bottom")
    axes[0][1].set_ylim(min(low, 0.4), high)
    for panel in axes[1]:
        style.decades(panel.xaxis)
        panel.set_xlabel("vertices of the limb")
    style.key_below(drawing)
    return drawing, behind
