"""How other deformers and the finite elements do under the bound of a claim: one row each of a Markdown table, computed from the values
that claims.json has for comparison (`controls`). They are no part of the verdict.

    compared_results.lines(claim, "pbs")  # a claim of sentences.claims_of; no line if nothing was measured under its bounds
"""
from words import case_words, sentences
from words.number_words import counted, span_of_thousandths


introduction = ("", "For comparison, the tables show other deformers and finite elements under the same bounds. "
                    "They are no part of the verdict.")


def held_by_runs(_, runs):
    """Frames within the bound, of all; and the smallest and the largest value of all frames."""
    frames = sum(run["frames"] for run in runs)
    held = sum(round(run["share_of_frames"]["estimate"] * run["frames"]) for run in runs)
    ends = [end for run in runs for end in (run["least"], run["most"])]
    return f"{held} of {counted(frames, 'frame')} in {counted(len(runs), 'run')}", [min(ends), max(ends)]


def held_by_values(bound, values):
    """Values within the bound, of all; and the smallest and the largest value."""
    low, high = (float(sign + "inf") if end is None else end for sign, end in (("-", bound["low"]), ("", bound["high"])))
    known = [value["value"] for value in values]
    return f"{sum(low <= value <= high for value in known)} of {counted(len(known), 'value')}", [min(known), max(known)]


def rows(claim, own, bound):
    """One row per deformer other than the claim's own, in the order of claims.json."""
    groups = {}
    for value in claim["controls"]:
        if value["quantity"] == bound["quantity"] and value.get("deformer") not in (None, own) and value.get("value") is not None:
            groups.setdefault(value["deformer"], []).append(value)
    for deformer, values in groups.items():
        held, ends = (held_by_runs if "frames" in values[0] else held_by_values)(bound, values)
        unit = " %" if bound["quantity"].endswith("_pct") else ""
        yield f"| {case_words.of_field('deformer', deformer)} | {span_of_thousandths(ends)}{unit} | {held} |"


def lines(claim, own):
    """A table per bounded quantity. own: the deformer that the claim is about, or None if it is not about a deformer alone."""
    found = []
    for bound in claim["bounds"] if own else []:
        if table := list(rows(claim, own, bound)):
            title = sentences.title(claim, bound["quantity"])
            found += ["", f"| deformer | {title} | within the bound |", "|---|---|---|", *table]
    return [line.replace("\u2212", "-") for line in [*introduction, *found]] if found else []
