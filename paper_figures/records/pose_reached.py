"""Whether a deformer reached the pose of a frame. A run writes its frame even if the solve failed; the column `outcome` of metrics.csv
records the result. A pose that was not reached cannot serve as a reference.

    if pose_reached.of(row): ...
    title += pose_reached.mark(row)  # "" or a line that states that it was not
"""
words = "pose not reached"


def of(row):
    """A record of an earlier version has no outcome and counts as reached."""
    return row.get("outcome") in (None, "", "finished")


def mark(row):
    return "" if of(row) else f"\n{words}"
