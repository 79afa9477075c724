"""PBS over 1,000 iterations from four initial guesses. The upper panels show the residual of the constraints, the lower ones the distance
to the finite element reference. The error does not follow the residual: in the twist it grows again while PBS converges to a different
shape. Starting from the previous frame or the rest pose, PBS has no information about the twist of a limb, so the residual is small and the
error large."""
import records
from drawing import style
from records import entries

cases = [("limb_twist", "twist_90", "limb, twist 90\u00b0"), ("limb_bend", "bend_60", "limb, bend 60\u00b0"),
         ("human", "01_01_crouch", "human, crouch")]
starts = {"lbs": "from LBS (the paper)", "previous_frame": "from the previous frame", "rest_pose": "from the rest pose",
          "rigid_bind": "from the nearest bone, rigidly"}
measures = [("residuals.csv", "combined", "combined residual [1]"), ("towards.csv", "error_joint_pct", "error at the joints [%]")]
ranges = {"combined": (5e-3, 5.0), "error_joint_pct": (0.5, 600.0)}
columns = {"pose", "order", "precision", "k_stretch", "start", "iteration"}


def of_case(file, column, pose, start):
    rows = [row for row in records.table(file, columns | {column})
            if (row["pose"], row["order"], row["precision"], row["start"]) == (pose, "ordered", "f32", start)
            and float(row["k_stretch"]) == 0.2]
    if not rows:
        raise records.RecordsMissing(f"{file}: no rows of {pose}, ordered f32, k_stretch 0.2, start {start}")
    return rows


def draw_panel(axes, file, column, pose):
    behind = []
    for number, (start, label) in enumerate(starts.items()):
        rows = of_case(file, column, pose, start)
        iterations, values = records.numbers(rows, "iteration"), records.numbers(rows, column)
        style.draw_series(axes, number, iterations, values, label)
        behind += [{"case": file.parent.name, "pose": pose, "start": start, "measure": column, "iteration": i, "value": v}
                   for i, v in zip(iterations, values)]
    axes.set_xscale("symlog", linthresh=1, linscale=0.4)
    axes.set_xticks([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1000"])
    axes.set_xlim(0, 1100)
    axes.axvline(24, color=style.black, linewidth=0.6)
    axes.set_yscale("log")
    axes.set_ylim(*ranges[column])
    write_below(axes, behind, ranges[column][0])
    return behind


def write_below(axes, drawn, low):
    """Names the initial guesses whose values lie below the panel throughout."""
    most = {label: max(row["value"] for row in drawn if row["start"] == start) for start, label in starts.items()}
    text = "\n".join(f"{label}: at most {value:.0e}" for label, value in most.items() if value < low)
    axes.annotate(text, (0.97, 0.97), xycoords="axes fraction", ha="right", va="top", fontsize=6,
                  bbox={"color": "white", "pad": 1.0})


def convergence_iterations(results, figures):
    folder = results / "convergence"
    figure, axes = style.panels(2, 3, height_in=1.9, sharex="col", sharey="row")
    behind = []
    for column, (case, pose, title) in enumerate(cases):
        for row, (table, measure, label) in enumerate(measures):
            behind += draw_panel(axes[row][column], folder / case / table, measure, pose)
            axes[row][0].set_ylabel(label)
        axes[0][column].set_title(title)
        axes[1][column].set_xlabel("iterations; line: the paper's 24")
    style.log_scale(axes[1][0].yaxis, [1, 2, 5, 10, 20, 50, 100, 200, 500])
    style.log_scale(axes[0][0].yaxis, [0.01, 0.1, 1])
    style.legend_above(figure)
    style.save(figure, figures / "convergence_iterations", entries.origin_of(results, "convergence_iterations"), behind)
