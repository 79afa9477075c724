"""The distances between two deformers' positions of the same points of a frame, as the study `frames` recorded them: a row of
distances.csv.

    recorded_distances.between(frames, 12, "pbs_jiggle", "pbs")["largest_mm"]
    recorded_distances.of_points_mm(frames, 12, "pbs_jiggle", "pbs")          # point by point, of the frames' own files
"""
import numpy

import records
from drawing import bodies, rendering


def between(frames, frame, one, other):
    """The row's numbers: points, rms_mm, largest_mm."""
    file = frames.folder / "distances.csv"
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: does not exist: the run is of an earlier version and has to be made again")
    for row in records.table(file, {"frame", "deformer", "other", "points", "rms_mm", "largest_mm"}):
        if int(row["frame"]) == frame and {row["deformer"], row["other"]} == {one, other}:
            return {"points": int(row["points"]), "rms_mm": float(row["rms_mm"]), "largest_mm": float(row["largest_mm"])}
    raise records.RecordsMissing(f"{file}: no frame {frame} of {one} and {other}")


def of_points_mm(frames, frame, one, other):
    """The distance of each point of the rendered surface, #S."""
    first, second = (bodies.points_of(frames.skin(label, frame)) for label in (one, other))
    return 1000 * numpy.linalg.norm(first - second, axis=1)


def bone_under(frames, point, tet_file):
    """The nearest bone of the vertex that carries the largest share of this point of the rendered surface."""
    tets, shares = frames.embedding()
    corners = rendering.corners_of(tet_file)
    carrier = int(corners[tets[point]][numpy.argmax(shares[point])])
    return next(row["bone"] for row in frames.binding() if int(row["vertex"]) == carrier)
