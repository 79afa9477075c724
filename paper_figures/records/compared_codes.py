"""The codes of the deformers in the two comparisons of error against run time: the best code of each, and plain f64 code.

    rows = compared_codes.taking_part(rows, "packed_f32")
"""


def is_plain(row):
    """A deformer of the user's own has no precision on record and takes part in both comparisons."""
    return row["precision"] != "f32" and row["packed"] != "1"


def code_rank(row):
    """The better code has the higher rank: packed f32, plain f32, packed f64, plain f64."""
    return 2 * (row["precision"] == "f32") + (row["packed"] == "1")


def taking_part(rows, comparison):
    """The points of a comparison: in packed_f32 those of the best code of each deformer."""
    if comparison == "plain_f64":
        return [row for row in rows if is_plain(row)]
    best = {}
    for row in rows:
        best[row["deformer"]] = max(best.get(row["deformer"], 0), code_rank(row))
    return [row for row in rows if code_rank(row) == best[row["deformer"]]]
