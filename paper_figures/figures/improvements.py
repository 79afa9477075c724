"""The gains of single changes to PBS: the mean error over the poses of each body against the time per frame, with marks at the numbers of
iterations, and the gain of each change in the time of 4, 24 and 96 iterations of PBS, with its interval over the poses. A gain that is
decided is drawn filled."""
import records
from drawing import omission_boxes, style
from records import entries
from words import case_words

names = {"pbs": "PBS (baseline)", "smooth_weights": "smooth weights", "bind_to_blended_position": "bind to blended position",
         "region_volumes": "volumes of regions", "tet_and_region_volumes": "volumes of tets and regions",
         "k_by_edge_length": "k by edge length", "another_order": "another order", "other_stiffnesses": "other stiffnesses (control)"}
looks = dict(zip(names, [(style.black, "o"), (style.vermillion, "v"), (style.green, "^"), (style.purple, "D"), (style.orange, "s"),
                         (style.sky, "P"), (style.blue, "x"), ("#999999", "+")]))
curve_columns = {"body", "change", "setting", "iterations", "poses", "mean_ms", "error_joint_pct"}
gain_columns = {"group", "budget_iterations", "change", "than", "poses", "gain_pct", "gain_low_pct", "gain_high_pct", "decision"}
budget_looks = {"4": (style.orange, "v"), "24": (style.blue, "o"), "96": (style.vermillion, "s")}


def draw_curves(axes, body, rows):
    for change, (color, marker) in looks.items():
        curve = [row for row in rows if row["change"] == change]
        if curve:
            axes.plot(records.numbers(curve, "mean_ms"), records.numbers(curve, "error_joint_pct"), color=color, marker=marker,
                      markersize=2.8, linewidth=2.0 if change == "pbs" else 1.0, label=names[change])
    style.log_scale(axes.xaxis)
    style.log_scale(axes.yaxis, [2, 3, 5, 7, 10, 15, 20, 30, 50, 70])
    axes.set_title(f"{case_words.of_field('body', body)}, mean of {rows[0]['poses']} poses")
    axes.set_xlabel("processor time per frame [ms]")
    axes.set_ylabel("error at the joints [%]")
    return [{"shown": "curve"} | {name: row[name] for name in sorted(curve_columns)} for row in rows]


def draw_gains(axes, rows):
    changes = [change for change in reversed(names) if any(row["change"] == change for row in rows)]
    for budget, (color, marker) in budget_looks.items():
        shift = 0.22 * (list(budget_looks).index(budget) - 1)
        for row in (row for row in rows if row["budget_iterations"] == budget):
            y, gain = changes.index(row["change"]) - shift, float(row["gain_pct"])
            if row["gain_low_pct"]:
                axes.plot([float(row["gain_low_pct"]), float(row["gain_high_pct"])], [y, y], color=color, linewidth=0.8)
            axes.plot([gain], [y], color=color, marker=marker, linestyle="none",
                      markerfacecolor=color if row["decision"] == "decided" else "white")
        axes.plot([], [], color=color, marker=marker, linestyle="none", label=f"gain in the time of {budget} iterations")
    axes.plot([], [], color=style.black, marker="o", linestyle="none", markerfacecolor="white", label="hollow: not decided")
    axes.axvline(0, color=style.black, linewidth=0.6)
    axes.set_xscale("symlog", linthresh=1.0)
    axes.set_xticks([-10, -1, 0, 1, 10], ["\u221210", "\u22121", "0", "1", "10"])
    axes.set_yticks(range(len(changes)), [names[change] for change in changes])
    axes.set_xlabel("gain over PBS in equal time [percentage points]; line: 95 % interval over the poses")
    return [{"shown": "gain"} | {name: row[name] for name in sorted(gain_columns)} for row in rows]


def omissions(rows):
    """The changes that have no value in every pose, and are not ranked: their means are over other poses."""
    changes, lines = dict.fromkeys(row["change"] for row in rows), []
    for budget in budget_looks:
        poses = {row["change"]: int(row["poses"]) for row in rows if row["budget_iterations"] == budget}
        most = max(poses.values(), default=0)
        lines += [f"not ranked: {names[change]} in the time of {budget} iterations: {poses.get(change, 0)} of {most} poses"
                  for change in changes if poses.get(change, 0) < most]
    return lines


def improvements(results, figures):
    folder = results / "work_precision"
    curves = records.table(folder / "curves.csv", curve_columns)
    gains = [row for row in records.table(folder / "gains.csv", gain_columns) if row["than"] == "pbs" and row["group"] == "all"]
    bodies = list(dict.fromkeys(row["body"] for row in curves))
    if not bodies:
        raise records.RecordsMissing(f"{folder}: no pose with a reference")
    figure, (upper, lower) = style.stacked((len(bodies), 2.9), (1, 2.7))
    behind = [row for panel, body in zip(upper, bodies)
              for row in draw_curves(panel, body, [row for row in curves if row["body"] == body])]
    behind += draw_gains(lower[0], gains)
    omitted = omissions(gains)
    omission_boxes.draw(lower[0], omitted, 110, place=(0.01, 0.02), fontsize=5)
    behind += [{"shown": "omission", "why": line} for line in omitted]
    upper[0].legend(loc="best", fontsize=6)
    lower[0].legend(loc="center right", fontsize=6)
    style.save(figure, figures / "improvements", entries.origin_of(results, "improvements"), style.aligned(behind))
