"""The comparisons of error against run time: the codes that take part, and the list of omissions that each figure has: which deformer is
missing, and why.

    omitted = omission_boxes.read(results)
    omission_boxes.draw(axes, omission_boxes.lines(rows), width=46)
"""
import collections
import textwrap

import records
from words import case_words

columns = {"comparison", "case", "deformer", "why", "missing", "points", "reason"}


def code_rank(row):
    """The better code has the higher rank: packed f32, plain f32, packed f64, plain f64. A deformer of the user's own has no precision on
    record and takes part in both comparisons."""
    return 2 * (row["precision"] == "f32") + (row["packed"] == "1")


def taking_part(rows, comparison):
    """The points of a comparison: in plain_f64 those of plain f64 code, in packed_f32 those of the best code of each deformer."""
    best = {}
    for row in rows if comparison != "plain_f64" else []:
        best[row["deformer"]] = max(best.get(row["deformer"], 0), code_rank(row))
    return [row for row in rows if code_rank(row) == best.get(row["deformer"], 0)]


def read(results):
    """The rows of omissions.csv. A record without omissions has none."""
    file = results / "work_precision" / "omissions.csv"
    return records.table(file, columns) if records.read_rows(file) else []


def points_of(results, needed):
    """The points of each case."""
    return {file.parent.name: records.table(file, needed) for file in sorted((results / "work_precision").glob("*/points.csv"))}


def added_up(results, comparison, cases):
    """One row per deformer and reason, of the points in all of these cases, whether they have the omission or not. The best code is that of
    all cases."""
    points = [{**row, "case": case} for case, rows in points_of(results, {"deformer", "precision", "packed", "outcome"}).items()
              for row in rows if row["outcome"] not in ("reference", "not_reached")]
    counts = collections.Counter(row["deformer"] for row in taking_part(points, comparison) if row["case"] in cases)
    sums = {}
    for row in read(results):
        if row["comparison"] == comparison and row["case"] in cases:
            so_far = sums.setdefault((row["deformer"], row["why"]), {**row, "missing": 0, "points": counts[row["deformer"]]})
            so_far["missing"] += int(row["missing"])
    return list(sums.values())


def lines(omitted):
    """One line per reason: diverged: XPBD 2 of 9, ... A reference that was not reached is followed by its worst tet."""
    of_reason, notes = {}, {}
    for row in omitted:
        share = f" {row['missing']} of {row['points']}" if int(row["missing"]) else ""
        of_reason.setdefault(row["why"], []).append(case_words.of_field("deformer", row["deformer"]) + share)
        if row["why"] == "no_reference" and row["reason"]:
            notes.setdefault(row["why"], row["reason"])
    words = case_words.tables["omission"]
    return [f"{words.get(why, why)}: {', '.join(names)}" + (f" ({notes[why]})" if why in notes else "") for why, names in of_reason.items()]


def text(shown, width, undecided=()):
    """The omissions and, if there are any, the groups that are not decided: a heading each, its lines filled to a width [characters]."""
    sections = [("Omissions:", shown or ["none"])] + ([("Not decided:", undecided)] if undecided else [])
    return "\n".join(line for heading, section in sections for line in
                     (heading, *(textwrap.fill(line, width, initial_indent="  ", subsequent_indent="    ") for line in section)))


def draw(axes, shown, width, undecided=(), place=(0.015, 0.02), fontsize=4.6):
    """A box in the lower left corner of a panel."""
    axes.text(*place, text(shown, width, undecided), transform=axes.transAxes, ha="left", va="bottom", fontsize=fontsize, linespacing=1.05,
              bbox={"boxstyle": "round,pad=0.25", "facecolor": "white", "edgecolor": "#999999", "linewidth": 0.4, "alpha": 0.9})


def draw_below(axes, shown, width, fontsize=5.5):
    """The list in a panel of its own, without axes."""
    axes.axis("off")
    axes.text(0.0, 1.0, text(shown, width), transform=axes.transAxes, ha="left", va="top", fontsize=fontsize, linespacing=1.15)
