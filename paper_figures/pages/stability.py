"""How many cells have each outcome, by body, method and factor, and how many broken initial shapes."""
import pages


def counts(rows, keys, outcomes):
    """A line for each group of rows with the same keys, in the order of their first rows."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row["outcome"])
    lines = [dict(zip(keys, group)) | {outcome: str(found.count(outcome)) for outcome in outcomes} for group, found in groups.items()]
    return pages.table(lines, {name: name for name in (*keys, *outcomes)})


def page(folder):
    keys, of_starts = ("body", "model", "factor", "second_factor"), ("body", "model", "pose", "setting", "setting_value")
    cells = pages.of_runs(folder, "cells.csv", {*keys, "outcome"})
    starts = pages.of_runs(folder, "starts.csv", {*of_starts, "outcome"})
    return ("# Stability\n\n## Cells\n\n" + counts(cells, keys, ("converged", "bounded", "inverted", "diverged", "not_finite"))
            + "\n## Broken initial shapes\n\n"
            + counts(starts, of_starts, ("reached", "not_reached", "diverged", "not_finite", "not_applicable")))
