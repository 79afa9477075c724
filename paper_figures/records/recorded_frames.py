"""The records of the study `frames` for one scene, by label and frame: tets, rendered surface, posed bones, binding,
and the frame's row.

    frames = Frames(results, "human_jump")
    file, row = frames.skin("pbs_jiggle", 12), frames.row("pbs_jiggle", 12)
"""
from dataclasses import dataclass

import numpy

import records
from records import shapes


@dataclass(frozen=True)
class Bone:
    name: str
    head: object  # end points [m]
    tail: object


class Frames:
    def __init__(self, results, scene=None):
        """Without a scene, the frames of any run, by its folder."""
        self.folder = results / "frames" / scene if scene else results
        self.run = records.Run(self.folder)
        shapes.check(self.folder / "run.json", self.run.record, shapes.shown_run)
        self.body = self.run.record["scene"]["character"]["body"]
        self.deformers = {run["label"]: (run["name"], run["variant"]) for run in self.run.record["scene"]["runs"]}

    def is_written(self, label, frame):
        return (self.folder / "frames" / f"{label}_{frame:06}.vtu").is_file()

    def tets(self, label, frame):
        return self._file(f"{label}_{frame:06}.vtu")

    def skin(self, label, frame):
        """The rendered surface; for the built-in bodies, which have none, the boundary of their tets."""
        return self.tets(label, frame) if self.body in built_in else self._file(f"{label}_surface_{frame:06}.vtp")

    def skin_at_rest(self):
        """The rendered surface at rest; None for the built-in bodies and for tets from a file, which have none."""
        has_none = self.body in built_in or (not self.body and not (self.folder / "surface_rest.vtp").is_file())
        return None if has_none else self._file("surface_rest.vtp", "")

    def embedding(self):
        """For each point of the rendered surface, the tet that carries it, #S, and the weight of each of the tet's
        corners, #S x 4."""
        rows = records.table(self._file("embedding.csv", ""), {"point", "tet", *share_columns})
        rows.sort(key=lambda row: int(row["point"]))
        shares = numpy.array([[float(row[column]) for column in share_columns] for row in rows])
        return numpy.array([int(row["tet"]) for row in rows]), shares

    def points_of_joints(self):
        """The points of the rendered surface that joints carry by more than one half, for they have no flesh of their
        own."""
        rows = records.table(self._file("embedding.csv", ""), {"point"})
        return {int(row["point"]) for row in rows if float(row.get("joint_share") or 0.0) > 0.5}

    def row(self, label, frame):
        if label not in self.deformers:
            raise records.RecordsMissing(f"{self.folder / 'run.json'}: no deformer labelled {label}")
        deformer, variant = self.deformers[label]
        for row in self.run.select(deformer, variant=variant):
            if int(row["frame"]) == frame:
                return row
        raise records.RecordsMissing(f"{self.folder / 'metrics.csv'}: no frame {frame} of {label}")

    def times_s(self):
        return records.numbers(self.run.select("lbs"), "time_s")

    def frames_at(self, *times_s):
        """The frames nearest to these times after the first one [s]."""
        own = numpy.array(self.times_s())
        return [int(abs(own - own[0] - time_s).argmin()) for time_s in times_s]

    def frame_at_angle(self, angle_deg):
        return int(records.at_angle(self.run.select("lbs"), angle_deg)["frame"])

    def bones(self, frame):
        rows = records.table(self.folder / "bones.csv", {"frame", "bone", *bone_ends})
        posed = [bone_of(row) for row in rows if int(row["frame"]) == frame]
        records.need(posed, f"{self.folder / 'bones.csv'}: no frame {frame}")
        return posed

    def bones_at_rest(self):
        return [bone_of(row) for row in records.table(self._file("bones_rest.csv", ""), {"bone", *bone_ends})]

    def binding(self):
        """One row per vertex: nearest bone, parameter on it, rest distance, blended and jiggles (0 or 1)."""
        return records.table(self.folder / "binding.csv", {"vertex", "bone", "parameter", "rest_distance_m", "blended",
                                                           "jiggles"})

    def projections(self, bones):
        """The position of each vertex's material point on its nearest bone [m], #V x 3, for the given posed bones."""
        bones = {bone.name: bone for bone in bones}
        rows = sorted(self.binding(), key=lambda row: int(row["vertex"]))
        heads, tails = (numpy.array([getattr(bones[row["bone"]], end) for row in rows]) for end in ("head", "tail"))
        parameters = numpy.clip([float(row["parameter"]) for row in rows], 0, 1)[:, None]
        return heads + parameters * (tails - heads)

    def apart(self, frame, one, other):
        """The distances between two deformers' positions of the same points of a frame: points, rms_mm, largest_mm."""
        file = self.folder / "distances.csv"
        records.need(file.is_file(), f"{file}: does not exist: the run is of an earlier version and has to be "
                                     "made again")
        for row in records.table(file, {"frame", "deformer", "other", "points", "rms_mm", "largest_mm"}):
            if int(row["frame"]) == frame and {row["deformer"], row["other"]} == {one, other}:
                return {"points": int(row["points"]), "rms_mm": float(row["rms_mm"]),
                        "largest_mm": float(row["largest_mm"])}
        raise records.RecordsMissing(f"{file}: no frame {frame} of {one} and {other}")

    def _file(self, name, below="frames"):
        file = self.folder / below / name
        records.need(file.is_file(), f"{file}: does not exist")
        return file


built_in = ("limb", "bar")
bone_ends = [f"{end}_{axis}_m" for end in ("head", "tail") for axis in "xyz"]
share_columns = [f"barycentric_{corner}" for corner in range(4)]


def bone_of(row):
    ends = numpy.array([float(row[column]) for column in bone_ends])
    return Bone(row["bone"], ends[:3], ends[3:])


def middle_of(points, binding, bones):
    """The mean position [m] of the vertices whose nearest bone is one of these; a camera is pointed at it."""
    return numpy.mean([points[int(row["vertex"])] for row in binding if row["bone"] in bones], axis=0)


def heading_of(bones):
    """Unit vectors of a posed body: forward along the floor, and to its left."""
    hips = {bone.name: bone.tail for bone in bones}
    left = (hips["hip.L"] - hips["hip.R"]) * (1, 0, 1)
    left /= numpy.linalg.norm(left)
    return numpy.cross(left, (0, 1, 0)), left
