"""The figures of the stability study: the cells of each factor and method, and two maps in which two settings change together. The five
outcomes have one look: darker is worse, and each has its own marker for grey prints."""
import textwrap

import records
from drawing import style
from words import case_words, looks
from words.number_words import listed

looks_of_outcomes = {"converged": ("#FFFFFF", "o", style.blue, "converged: at rest, as if undisturbed"),
                     "bounded": ("#E3EEF7", "s", style.sky, "bounded: moving, or at rest elsewhere"),
                     "inverted": ("#F6CFA0", "v", style.vermillion, "inverted tets at the end"),
                     "diverged": ("#C08A9F", "x", style.black, "diverged"),
                     "not_finite": ("#5A5A5A", "*", style.yellow, "not finite")}


def draw_marks(axes, places, outcomes, size):
    """places: (x, y) of each outcome."""
    for outcome, (_, marker, color, text) in looks_of_outcomes.items():
        shown = [place for place, found in zip(places, outcomes) if found == outcome]
        if shown:
            fill = {"c": color, "edgecolors": style.black} if marker == "*" else {"color": color}  # yellow alone is not visible on white
            axes.scatter(*zip(*shown), s=size * (3.5 if marker == "*" else 1), marker=marker, **fill,
                         linewidths=0.3 if marker == "*" else 0.9, label=text, zorder=3)


def legend_of_outcomes(figure, axes):
    """A legend of all five outcomes, so that a reader sees which do not occur."""
    for _, marker, color, text in looks_of_outcomes.values():
        axes.plot([], [], linestyle="none", marker=marker, color=color, markeredgecolor=style.black if marker == "*" else color,
                  markeredgewidth=0.6 if marker == "*" else 0.8, markersize=9 if marker == "*" else 4.5, label=text)
    style.legend_above(figure, columns=3)


# Every disturbance of the limb with every method, and its outcome. Each row is a quantity that is varied to its extremes, with marks from
# the smallest to the largest value. The figure shows which methods come to rest as if undisturbed, which leave tets inverted, and whether
# any method except the printed form of PBS diverges.

models = ("pbs", "pbs_no_memory", "pbs_jiggle", "xpbd", "xpbd_small_steps", "fem_linear", "fem_corotational", "fem_stable_neo_hookean",
          "fem_stable_neo_hookean_in_time")
cell_columns = {"body", "model", "factor", "value", "unit", "named", "second_factor", "precision", "outcome"}


def range_of(rows):
    if all(row["named"] and not row["unit"] for row in rows):
        return ", ".join(dict.fromkeys(case_words.in_plain(row["named"]) for row in rows))
    values = sorted(float(row["value"]) for row in rows)
    unit = {"1": "", "deg": "\u00b0"}.get(rows[0]["unit"], " " + rows[0]["unit"])
    return f"{values[0]:g}{unit}" + (f" to {values[-1]:g}{unit}" if values[-1] > values[0] else "")


def draw_factor(axes, rows, place):
    """One row of cells, with the marks of the models side by side."""
    for across, model in enumerate(models):
        cells = sorted((row for row in rows if row["model"] == model), key=lambda row: float(row["value"]))
        if not cells:
            continue
        step = 0.8 / max(len(cells), 4)
        places = [(across + (number - (len(cells) - 1) / 2) * step, place) for number in range(len(cells))]
        worst = max((cell["outcome"] for cell in cells), key=list(looks_of_outcomes).index)
        axes.fill_between([across - 0.48, across + 0.48], place - 0.42, place + 0.42, color=looks_of_outcomes[worst][0], linewidth=0)
        draw_marks(axes, places, [cell["outcome"] for cell in cells], size=9 if len(cells) < 6 else 4)


def factors_with(rows, model, outcome):
    of = dict.fromkeys(row["factor"] for row in rows if (row["model"], row["outcome"]) == (model, outcome))
    return [case_words.of_field("factor", factor) for factor in of]


def stability_cells_facts(rows):
    """For each method, how many cells come to rest, and which factors lead to another outcome."""
    present = [model for model in models if any(row["model"] == model for row in rows)]

    def at_rest(model):
        ends = [row["outcome"] for row in rows if row["model"] == model]
        return f"{looks.of(model).name} in {ends.count('converged')} of {len(ends)}"

    def by_method(outcome):
        found = {model: factors_with(rows, model, outcome) for model in present}
        return listed([f"{looks.of(model).name} ({' and '.join(factors)})" for model, factors in found.items() if factors], "; ")

    return {"at_rest": listed([at_rest(model) for model in present], "; "), "diverged": by_method("diverged"),
            "not_finite": by_method("not_finite"), "inverted_pbs": listed(factors_with(rows, "pbs", "inverted"), "; "),
            "inverted_jiggle": listed(factors_with(rows, "pbs_jiggle", "inverted"), "; ")}


def stability_cells(results):
    """The rows of the limb with one factor varied at a time, in the precision of most of a model's cells."""
    rows = [row for row in records.table(results / "stability" / "cells.csv", cell_columns)
            if row["body"] == "limb" and not row["second_factor"] and row["model"] in models]
    single = {row["model"] for row in rows if row["precision"] == "f32"}
    rows = [row for row in rows if row["precision"] == "f32" or row["model"] not in single]
    of_factors = {factor: [row for row in rows if row["factor"] == factor] for factor in dict.fromkeys(row["factor"] for row in rows)}
    figure, ((panel,),) = style.panels(1, 1, height_in=0.6 + 0.21 * len(of_factors), width_in=style.page_in)
    for place, cells in enumerate(of_factors.values()):
        draw_factor(panel, cells, place)
    panel.set_xticks(range(len(models)), [textwrap.fill(looks.of(model).name, 12) for model in models])
    panel.set_xlim(-0.5, len(models) - 0.5)
    style.name_rows(panel, [f"{case_words.of_field('factor', factor)}: {range_of(cells)}" for factor, cells in of_factors.items()])
    panel.xaxis.tick_top()
    panel.tick_params(labelsize=6)
    panel.tick_params(axis="x", labelsize=5)  # names of neighbouring columns may not touch
    panel.grid(False)
    legend_of_outcomes(figure, panel)
    return figure, style.taken(rows, ("body", "model", "factor", "value", "unit", "named", "precision", "outcome"))


# The outcome of jiggling PBS on the limb, disturbed and then held still, as two settings change together, cell by cell. The maps show
# which settings leave tets inverted, which prevent the body from coming to rest, and whether any lets the motion grow without bound.

maps = {"map_time_step_k_stretch.csv": "24 iterations", "map_iterations_twist.csv": "time step 10 ms"}
columns = {"factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision", "outcome", "steps"}


def named(factor, unit):
    words = case_words.of_field("factor", factor)
    return f"{words} [{'degrees' if unit == 'deg' else unit}]" if unit != "1" or factor == "k_stretch" else words


def draw_map(axes, rows, title):
    across = sorted({float(row["value"]) for row in rows})
    up = sorted({float(row["second_value"]) for row in rows})
    places = [(across.index(float(row["value"])), up.index(float(row["second_value"]))) for row in rows]
    for (x, y), row in zip(places, rows):
        axes.fill_between([x - 0.5, x + 0.5], y - 0.5, y + 0.5, color=looks_of_outcomes[row["outcome"]][0], linewidth=0)
    draw_marks(axes, places, [row["outcome"] for row in rows], size=26)
    axes.set_xticks(range(len(across)), [f"{value:g}" for value in across])
    axes.set_yticks(range(len(up)), [f"{value:g}" for value in up])
    axes.set(xlim=(-0.5, len(across) - 0.5), ylim=(-0.5, len(up) - 0.5), title=f"limb, PBS with jiggle, {title}",
             xlabel=named(rows[0]["factor"], rows[0]["unit"]), ylabel=named(rows[0]["second_factor"], rows[0]["second_unit"]))
    axes.grid(False)


def stability_maps_facts(rows):
    """The number of cells of each map by outcome, and the steps of the longest run."""
    def counts(file):
        found = [row["outcome"] for row in rows if row["map"] == file]
        return f"of {len(found)} cells " + ", ".join(f"{found.count(end)} {case_words.of_field('end', end)}" for end in looks_of_outcomes)

    left, right = map(counts, maps)
    return {"left": left, "right": right, "steps": max(int(row["steps"]) for row in rows)}


def stability_maps(results):
    figure, (axes,) = style.panels(1, 2, height_in=2.3)
    behind = []
    for panel, (file, title) in zip(axes, maps.items()):
        rows = records.table(results / "stability" / file, columns)
        draw_map(panel, rows, title)
        behind += style.taken(rows, sorted(columns), map=file)
    legend_of_outcomes(figure, axes[0])
    return figure, behind
