"""The parts of the error of PBS. Its error against the reference is split into the solver's part, the part of the
converged constraints, and the bound on the reference's own discretisation error, over the iterations."""
import math

import records
from drawing import style
from words import case_words

parts = {"error_joint_pct": ("whole error", style.ink, "x", "-"),
         "solver_pct": ("solver", style.rose, "v", (0, (4, 1.5))), "model_pct": ("model", style.indigo, "o", "-"),
         "discretisation_pct": ("discretisation (bound)", style.teal, "^", (0, (1, 1)))}
case_columns = ("body", "motion", "pose", "angle_deg")
attachment_columns = {*case_columns, "k_stretch", "reference", "model", "attachment", "spring_factor", "core_radius",
                      "model_pct"}


def with_k_stretch(rows, k_stretch):
    return [row for row in rows if math.isclose(float(row["k_stretch"]), k_stretch)]


def draw_part(axes, rows, column, **others):
    label, color, marker, line = parts[column]
    style.plot(axes, rows, "iterations", column, **{"color": color, "marker": marker, "linestyle": line,
                                                    "label": label} | others)


# The parts in two poses. The lower panels show how flesh that the bones hold in other ways, and the linear model,
# change the model's part.

def draw_parts(axes, rows, pose):
    drawn = []
    for k_stretch, shade in ((0.2, 1.0), (0.9, 0.35)):
        chosen = with_k_stretch(rows, k_stretch)
        records.need(chosen, f"parts.csv of {pose}: no row with k_stretch {k_stretch}")
        for column in parts:
            draw_part(axes, chosen, column, alpha=shade, **({} if shade == 1.0 else {"label": None}))
        drawn += [{"pose": pose, "k_stretch": row["k_stretch"], "shown": column, "at": row["iterations"],
                   "value_pct": row[column]}
                  for row in chosen for column in parts]
    style.log_scale(axes.xaxis, sorted({float(row["at"]) for row in drawn}))
    axes.set_ylim(bottom=0)
    axes.set(xlabel="iterations", ylabel="error at the joint [%]", title=f"{case_words.posed(rows[0])}; k_stretch 0.2, "
                                                                         "faint: 0.9")
    return drawn


def name_of(row):
    """The flesh by its attachment, smooth springs by their q and the radius of the core; the linear model is named, the
    law of the reference is not."""
    if row["model"] == "linear":
        return f"linear {row['attachment']}"
    if row["attachment"] == "smooth":
        return f"q {float(row['spring_factor']):g}, core {float(row['core_radius']):g}"
    return "bind constraint" if row["attachment"] == "bind" else row["attachment"]


def draw_attachments(axes, rows, pose):
    """The reference itself is the first row, at the top."""
    chosen = with_k_stretch(rows, 0.2)[::-1]
    axes.barh([name_of(row) for row in chosen], [float(row["model_pct"] or "nan") for row in chosen], color=style.cyan,
              height=0.6)
    axes.set_ylim(-0.5, len(chosen) - 0.5)
    for place, row in enumerate(chosen):
        if not math.isfinite(float(row["model_pct"] or "nan")):
            axes.annotate("not reached", (0.01, place), xycoords=("axes fraction", "data"), va="center",
                          fontsize=style.tick_size)
    axes.set_xlabel("converged PBS from flesh [%]")
    axes.grid(axis="y", visible=False)
    return [{"pose": pose, "k_stretch": row["k_stretch"], "shown": "model_pct", "at": name_of(row),
             "value_pct": row["model_pct"]}
            for row in chosen]


def error_split(results):
    figure, axes = style.panels(2, 2, height_in=2.3)
    behind = []
    for (upper, lower), pose in zip(axes.T, ("limb_twist_90", "limb_bend_60")):
        folder = results / "ensemble" / pose
        behind += draw_parts(upper, records.table(folder / "parts.csv",
                                                  {*case_columns, "k_stretch", "iterations", *parts}), pose)
        behind += draw_attachments(lower, records.table(folder / "attachments.csv", attachment_columns), pose)
    style.key_below(figure)
    return figure, behind
