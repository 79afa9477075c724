"""The figures of the stability study: the cells of each factor and method, and two maps in which two settings change
together. The five outcomes have one look: darker is worse, and each has its own marker for grey prints."""
import textwrap

import records
from drawing import style
from words import case_words, looks

looks_of_outcomes = {"converged": ("o", style.indigo, "converged: at rest, as if undisturbed"),
                     "bounded": ("s", style.cyan, "bounded: moving, or at rest elsewhere"),
                     "inverted": ("v", style.rose, "inverted tets at the end"),
                     "diverged": ("x", style.ink, "diverged"), "not_finite": ("*", style.olive, "not finite")}
shades = dict(zip(looks_of_outcomes, looks.palette["outcomes"]))


def draw_marks(axes, places, outcomes, size):
    """places: (x, y) of each outcome."""
    for outcome, (marker, color, text) in looks_of_outcomes.items():
        shown = [place for place, found in zip(places, outcomes) if found == outcome]
        if shown:
            axes.scatter(*zip(*shown), s=size * (3.5 if marker == "*" else 1), marker=marker, color=color,
                         linewidths=0.3 if marker == "*" else 0.9, label=text, zorder=3)


def legend_of_outcomes(figure, axes, found):
    """A key of the outcomes that occur."""
    for marker, color, text in (look for outcome, look in looks_of_outcomes.items() if outcome in found):
        axes.plot([], [], linestyle="none", marker=marker, color=color, markersize=9 if marker == "*" else 4.5,
                  label=text)
    style.key_below(figure)


def counts(rows):
    """Cells, and how many of them have each outcome."""
    found = [row["outcome"] for row in rows]
    return {"cells": len(found)} | {outcome: found.count(outcome) for outcome in looks_of_outcomes}


# Every disturbance of the limb with every method, and its outcome. Each row is a quantity that is varied to its
# extremes, with marks from the smallest to the largest value. The figure shows which methods come to rest as if
# undisturbed, which leave tets inverted, and whether any method except the printed form of PBS diverges.

models = ("pbs", "pbs_no_memory", "pbs_jiggle", "xpbd", "xpbd_small_steps", "fem_linear", "fem_corotational",
          "fem_stable_neo_hookean", "fem_stable_neo_hookean_in_time")
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
        axes.fill_between([across - 0.48, across + 0.48], place - 0.42, place + 0.42, color=shades[worst], linewidth=0)
        draw_marks(axes, places, [cell["outcome"] for cell in cells], size=9 if len(cells) < 6 else 4)


def stability_cells(results):
    """The rows of the limb with one factor varied at a time, in the precision of most of a model's cells."""
    rows = [row for row in records.table(results / "stability" / "cells.csv", cell_columns)
            if row["body"] == "limb" and not row["second_factor"] and row["model"] in models]
    single = {row["model"] for row in rows if row["precision"] == "f32"}
    rows = [row for row in rows if row["precision"] == "f32" or row["model"] not in single]
    of_factors = {factor: [row for row in rows if row["factor"] == factor]
                  for factor in dict.fromkeys(row["factor"] for row in rows)}
    figure, ((panel,),) = style.panels(1, 1, height_in=1.6 + 0.27 * len(of_factors))
    for place, cells in enumerate(of_factors.values()):
        draw_factor(panel, cells, place)
    panel.set_xticks(range(len(models)), [textwrap.fill(looks.short(model), 20) for model in models], rotation=90)
    panel.set_xlim(-0.5, len(models) - 0.5)
    style.name_rows(panel, [f"{case_words.of_field('factor', factor)}: {range_of(cells)}"
                            for factor, cells in of_factors.items()])
    panel.xaxis.tick_top()
    panel.grid(False)
    legend_of_outcomes(figure, panel, {row["outcome"] for row in rows})
    return figure, style.taken(rows, ("body", "model", "factor", "value", "unit", "named", "precision", "outcome"))


stability_cells_facts = counts


# The outcome of jiggling PBS on the limb, disturbed and then held still, as two settings change together, cell by cell.
# The maps show which settings leave tets inverted, which prevent the body from coming to rest, and whether any lets the
# motion grow without bound.

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
        axes.fill_between([x - 0.5, x + 0.5], y - 0.5, y + 0.5, color=shades[row["outcome"]], linewidth=0)
    draw_marks(axes, places, [row["outcome"] for row in rows], size=26)
    axes.set_xticks(range(len(across)), [f"{value:g}" for value in across])
    axes.set_yticks(range(len(up)), [f"{value:g}" for value in up])
    axes.set(xlim=(-0.5, len(across) - 0.5), ylim=(-0.5, len(up) - 0.5), title=f"limb, PBS with jiggle, {title}",
             xlabel=named(rows[0]["factor"], rows[0]["unit"]),
             ylabel=named(rows[0]["second_factor"], rows[0]["second_unit"]))
    axes.grid(False)


def stability_maps_facts(rows):
    """The steps of the longest run, and how many cells come to rest."""
    return counts(rows) | {"steps": max(int(row["steps"]) for row in rows)}


def stability_maps(results):
    figure, axes = style.panels(2, 1, height_in=2.2)
    behind = []
    for (panel,), (file, title) in zip(axes, maps.items()):
        rows = records.table(results / "stability" / file, columns)
        draw_map(panel, rows, title)
        behind += style.taken(rows, sorted(columns), map=file)
    legend_of_outcomes(figure, axes[0][0], {row["outcome"] for row in behind})
    return figure, behind
