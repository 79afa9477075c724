"""How far apart two deformers put the same points of a frame, as the study `frames` recorded it: a row of distances.csv.

    recorded_distances.between(frames, 12, "pbs_jiggle", "pbs")["largest_mm"]
"""
import records


def between(frames, frame, one, other):
    """Its numbers: points, rms_mm, largest_mm."""
    file = frames.folder / "distances.csv"
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: not there: the run is of an earlier version and has to be made again")
    for row in records.table(file, {"frame", "deformer", "other", "points", "rms_mm", "largest_mm"}):
        if int(row["frame"]) == frame and {row["deformer"], row["other"]} == {one, other}:
            return {"points": int(row["points"]), "rms_mm": float(row["rms_mm"]), "largest_mm": float(row["largest_mm"])}
    raise records.RecordsMissing(f"{file}: no frame {frame} of {one} and {other}")
