"""Whether a deformer reached a frame's pose. A run writes its frame whatever came of the solve; metrics.csv says what did (`outcome`). What
was not reached is no truth that others may be measured against.

    if pose_reached.of(row): ...
    title += pose_reached.mark(row)  # "" or a line that says it was not
"""
words = "pose not reached"


def of(row):
    """A record of an earlier version has no outcome and is taken at its word."""
    return row.get("outcome") in (None, "", "finished")


def mark(row):
    return "" if of(row) else f"\n{words}"
