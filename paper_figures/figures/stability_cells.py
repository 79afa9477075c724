"""Every disturbance of the limb with every method, and its outcome. Each row is a quantity that is varied to its extremes, with marks from
the smallest to the largest value. The figure shows which methods come to rest as if undisturbed, which leave tets inverted, and whether any
method except the printed form of PBS diverges."""
import textwrap

import records
from drawing import outcomes, style
from records import entries
from words import case_words, looks
from words.number_words import listed

models = ("pbs", "pbs_no_memory", "pbs_jiggle", "xpbd", "xpbd_small_steps", "fem_linear", "fem_corotational", "fem_stable_neo_hookean",
          "fem_stable_neo_hookean_in_time")
columns = {"body", "model", "factor", "value", "unit", "named", "second_factor", "precision", "outcome"}


def shown_cells(rows):
    """The rows of the limb with one factor varied at a time, in the precision of most of a model's cells."""
    rows = [row for row in rows if row["body"] == "limb" and not row["second_factor"] and row["model"] in models]
    single = {row["model"] for row in rows if row["precision"] == "f32"}
    return [row for row in rows if row["precision"] == "f32" or row["model"] not in single]


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
        worst = max((cell["outcome"] for cell in cells), key=list(outcomes.looks).index)
        axes.fill_between([across - 0.48, across + 0.48], place - 0.42, place + 0.42, color=outcomes.looks[worst][0], linewidth=0)
        outcomes.draw_marks(axes, places, [cell["outcome"] for cell in cells], size=9 if len(cells) < 6 else 4)


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


def stability_cells(results, figures):
    folder = results / "stability"
    rows = shown_cells(records.table(folder / "cells.csv", columns))
    factors = list(dict.fromkeys(row["factor"] for row in rows))
    figure, axes = style.panels(1, 1, height_in=0.6 + 0.21 * len(factors), width_in=style.page_in)
    panel = axes[0][0]
    labels = []
    for place, factor in enumerate(factors):
        cells = [row for row in rows if row["factor"] == factor]
        draw_factor(panel, cells, place)
        labels.append(f"{case_words.of_field('factor', factor)}: {range_of(cells)}")
    panel.set_xticks(range(len(models)), [textwrap.fill(looks.of(model).name, 12) for model in models])
    panel.set_yticks(range(len(factors)), labels)
    panel.set(xlim=(-0.5, len(models) - 0.5), ylim=(len(factors) - 0.5, -0.5))
    panel.xaxis.tick_top()
    panel.tick_params(labelsize=6)
    panel.grid(False)
    outcomes.legend(figure, panel)
    kept = ("body", "model", "factor", "value", "unit", "named", "precision", "outcome")
    behind = [{column: row[column] for column in kept} for row in rows]
    style.save(figure, figures / "stability_cells", entries.origin_of(results, "stability_cells"), behind)
