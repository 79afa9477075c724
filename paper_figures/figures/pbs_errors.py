"""The parts of the error of PBS, and what would reduce it. Its error against the reference is split into the solver's part, the part of the
converged constraints, and the bound on the reference's own discretisation error, over the iterations."""
import math

import records
from drawing import style
from words import case_words, looks

parts = {"error_joint_pct": ("whole error", style.black, "x", "-"), "solver_pct": ("solver", style.vermillion, "v", (0, (4, 1.5))),
         "model_pct": ("model", style.blue, "o", "-"), "discretisation_pct": ("discretisation (bound)", style.green, "^", (0, (1, 1)))}
case_columns = ("body", "motion", "pose", "angle_deg")
attachment_columns = {*case_columns, "k_stretch", "reference", "model", "attachment", "spring_factor", "core_radius", "model_pct"}


def with_k_stretch(rows, k_stretch):
    return [row for row in rows if math.isclose(float(row["k_stretch"]), k_stretch)]


def draw_part(axes, rows, column, **others):
    label, color, marker, line = parts[column]
    style.plot(axes, rows, "iterations", column, **{"color": color, "marker": marker, "linestyle": line, "label": label} | others)


# The parts in two poses. The lower panels show how flesh that the bones hold in other ways, and the linear model, change the model's part.

def draw_parts(axes, rows, pose):
    drawn = []
    for k_stretch, shade in ((0.2, 1.0), (0.9, 0.35)):
        chosen = with_k_stretch(rows, k_stretch)
        records.need(chosen, f"parts.csv of {pose}: no row with k_stretch {k_stretch}")
        for column in parts:
            draw_part(axes, chosen, column, alpha=shade, **({} if shade == 1.0 else {"label": None}))
        drawn += [{"pose": pose, "k_stretch": row["k_stretch"], "shown": column, "at": row["iterations"], "value_pct": row[column]}
                  for row in chosen for column in parts]
    style.log_scale(axes.xaxis, sorted({float(row["at"]) for row in drawn}))
    axes.set_ylim(bottom=0)
    axes.set(xlabel="iterations", ylabel="error at the joint [%]", title=f"{case_words.posed(rows[0])}; k_stretch 0.2, faint: 0.9")
    return drawn


def name_of(row):
    """The flesh by its attachment, smooth springs by their q and the radius of the core; the linear model is named, the law of the
    reference is not."""
    if row["model"] == "linear":
        return f"linear {row['attachment']}"
    if row["attachment"] == "smooth":
        return f"q {float(row['spring_factor']):g}, core {float(row['core_radius']):g}"
    return "bind constraint" if row["attachment"] == "bind" else row["attachment"]


def draw_attachments(axes, rows, pose):
    """The reference itself is the first row, at the top."""
    chosen = with_k_stretch(rows, 0.2)[::-1]
    axes.barh([name_of(row) for row in chosen], [float(row["model_pct"] or "nan") for row in chosen], color=style.sky, height=0.6)
    axes.set_ylim(-0.5, len(chosen) - 0.5)
    for place, row in enumerate(chosen):
        if not math.isfinite(float(row["model_pct"] or "nan")):
            axes.annotate("not reached", (0.01, place), xycoords=("axes fraction", "data"), va="center", fontsize=style.tick_size)
    axes.set_xlabel("converged PBS from flesh [%]")
    axes.grid(axis="y", visible=False)
    return [{"pose": pose, "k_stretch": row["k_stretch"], "shown": "model_pct", "at": name_of(row), "value_pct": row["model_pct"]}
            for row in chosen]


def error_split(results):
    figure, axes = style.panels(2, 2, height_in=2.3)
    behind = []
    for (upper, lower), pose in zip(axes.T, ("limb_twist_90", "limb_bend_60")):
        folder = results / "ensemble" / pose
        behind += draw_parts(upper, records.table(folder / "parts.csv", {*case_columns, "k_stretch", "iterations", *parts}), pose)
        behind += draw_attachments(lower, records.table(folder / "attachments.csv", attachment_columns), pose)
    style.legend_above(figure, columns=4)
    return figure, behind


# The gains of single changes to PBS: the mean error over the poses of each body against the time per frame, with marks at the numbers of
# iterations, and the gain of each change in the time of 4, 24 and 96 iterations of PBS, with its range over the poses. A gain that is
# decided is drawn filled.

markers = {"smooth_weights": "v", "bind_to_blended_position": "^", "region_volumes": "D", "tet_and_region_volumes": "s",
           "k_by_edge_length": "P", "another_order": "x", "other_stiffnesses": "+"}
changes = dict(zip(markers, zip(looks.palette["changes"], markers.values())))  # no deformer has one of these colours
names = {"pbs": f"{looks.of('pbs').name} (baseline)"} | {change: case_words.of_field("change", change) for change in changes}
curve_columns = {"body", "change", "setting", "iterations", "poses", "mean_ms", "error_joint_pct"}
gain_columns = {"group", "budget_iterations", "change", "than", "poses", "gain_pct", "gain_low_pct", "gain_high_pct", "decision"}
looks_of_budgets = {"4": (style.orange, "v"), "24": (style.blue, "o"), "96": (style.vermillion, "s")}


def draw_curves(axes, body, rows):
    for change, name in names.items():
        color, marker = changes.get(change, (None, None))  # without those of the baseline
        look = {"color": color, "marker": marker, "linewidth": 1.0} if color else style.as_of(change, linewidth=2.0)
        curve = [row for row in rows if row["change"] == change]
        if curve:
            style.plot(axes, curve, "mean_ms", "error_joint_pct", **look | {"markersize": 2.8, "label": name})
    style.log_scale(axes.xaxis)
    style.log_scale(axes.yaxis, [2, 3, 5, 7, 10, 15, 20, 30, 50, 70])
    axes.set(title=f"{case_words.of_field('body', body)}, mean of {rows[0]['poses']} poses", xlabel="processor time per frame [ms]",
             ylabel="error at the joints [%]")
    return style.taken(rows, sorted(curve_columns), shown="curve")


def draw_gains(axes, rows):
    named = [change for change in reversed(names) if any(row["change"] == change for row in rows)]
    for place, (budget, (color, marker)) in enumerate(looks_of_budgets.items()):
        for row in (row for row in rows if row["budget_iterations"] == budget):
            y, gain = named.index(row["change"]) - 0.22 * (place - 1), float(row["gain_pct"])
            if row["gain_low_pct"]:
                axes.hlines(y, float(row["gain_low_pct"]), float(row["gain_high_pct"]), color=color, linewidth=0.8)
            axes.plot([gain], [y], color=color, marker=marker, linestyle="none",
                      markerfacecolor=color if row["decision"] == "decided" else "white")
        axes.plot([], [], color=color, marker=marker, linestyle="none", label=f"in the time of {budget} iterations")
    axes.plot([], [], color=style.black, marker="o", linestyle="none", markerfacecolor="white", label="hollow: not decided")
    axes.axvline(0, color=style.black, linewidth=0.6)
    axes.set_xscale("symlog", linthresh=1.0)
    axes.set_xticks([-10, -1, 0, 1, 10], ["\u221210", "\u22121", "0", "1", "10"])
    axes.set_yticks(range(len(named)), [names[change] for change in named])
    axes.set_xlabel("gain over PBS in equal time [percentage points]; line: 95 % range over the poses")
    return style.taken(rows, sorted(gain_columns), shown="gain")


def not_ranked(rows):
    """The changes that have no value in every pose, and are not ranked: their means are over other poses."""
    named, lines = dict.fromkeys(row["change"] for row in rows), []
    for budget in looks_of_budgets:
        poses = {row["change"]: int(row["poses"]) for row in rows if row["budget_iterations"] == budget}
        most = max(poses.values(), default=0)
        lines += [f"not ranked: {names[change]} in the time of {budget} iterations: {poses.get(change, 0)} of {most} poses"
                  for change in named if poses.get(change, 0) < most]
    return lines


def improvements(results):
    folder = results / "work_precision"
    curves = records.table(folder / "curves.csv", curve_columns)
    gains = [row for row in records.table(folder / "gains.csv", gain_columns) if row["than"] == "pbs" and row["group"] == "all"]
    bodies = list(dict.fromkeys(row["body"] for row in curves))
    records.need(bodies, f"{folder}: no pose with a reference")
    figure, (upper, (lower,)) = style.stacked((len(bodies), 2.9), (1, 2.7))
    behind = [row for panel, body in zip(upper, bodies) for row in draw_curves(panel, body, [row for row in curves if row["body"] == body])]
    behind += draw_gains(lower, gains)
    omitted = not_ranked(gains)
    lower.legend(loc="upper center", bbox_to_anchor=(0.35, -0.15), ncol=4)
    style.label_lines(upper)
    return figure, behind + [{"shown": "omission", "why": line} for line in omitted]
