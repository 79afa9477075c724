"""Packs the recorded frames of DIR/frames into one block of bytes, with a header that describes its contents, for the
interactive viewer.

Positions are rounded to a grid of 65536 steps over the longest edge of the run's bounding box: low_m + step_m * code,
so that each coordinate is within step_m / 2 of the record. A frame is stored as the difference of its codes to those of
the previous frame (modulo 65536), first the low bytes of all frames, then the high ones, which compresses well.
The rendered surface is not stored frame by frame: each of its points is the weighted sum of the corners of the tet that
carries it (float32 weights), and so within step_m / 2 times the sum of the absolute weights.
Volume ratios take one byte: 0 is an inverted tet (ratio <= 0), a code c > 0 represents (c - 1) / 127, and 255 all
ratios above 2. Contact takes one byte per vertex: 0 is none, 1 touching, and a code c > 1 an overlap of (c - 2) / 2 mm,
255 all that are deeper. Millimetres are those of a body whose largest extent at rest is 1.7 m, like the distances of
metrics.csv.
"""
import gzip
import hashlib
import math

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import records
from drawing import rendering
from records import entries, recorded_frames
from words import looks

titles = {"limb_twist": "limb, twist", "limb_bend": "limb, bend", "human_jump": "human, jumping",
          "human_walk": "human, walking"}
figures = ("volume_change_pct", "inverted_tets", "j_min", "error_joint_pct", "error_linf_m", "skin_rms_mm",
           "min_section_pct", "angle_deg", "masked_share_pct")
ratio_steps, position_steps, contact_step_mm = 127, 65535, 0.5


def read_frame(file):
    """Positions [m], #V x 3, tets, #T x 4, volume ratios, #T, rest positions [m], #V x 3, depths of contact [um], #V
    (None in older frames)."""
    grid = rendering.read(file)
    ratio, rest = grid.GetCellData().GetArray("volume_ratio"), grid.GetPointData().GetArray("rest_position")
    if not ratio or not rest:
        raise records.RecordsMissing(f"{file}: no {'rest_position' if ratio else 'volume_ratio'}")
    arrays = (vtk_to_numpy(grid.GetPoints().GetData()), rendering.corners_of(grid), vtk_to_numpy(ratio),
              vtk_to_numpy(rest))
    depth = grid.GetPointData().GetArray("contact_depth_um")
    return *(numpy.array(array) for array in arrays), numpy.array(vtk_to_numpy(depth)) if depth else None


def rounded_up(value):
    """To one digit, 1, 2 or 5, for the end of a scale; 1 for what is not above zero."""
    if not value > 0:
        return 1.0
    step = 10.0 ** math.floor(math.log10(value))
    return next(one * step for one in (1, 2, 5, 10) if one * step >= value * (1 - 1e-9))


def scales_of(read, positions, reference, rest):
    """Millimetres of a body of 1.7 m per metre of this one. In these millimetres: the ends of the scales of difference
    and overlap, which one in a hundred vertices, or overlapping vertices, exceeds. positions: of the frames whose pose
    was reached."""
    mm_per_m = 1.7e3 / float((rest.max(axis=0) - rest.min(axis=0)).max())
    truth = positions.get(reference)
    apart_m = [numpy.linalg.norm(of - truth, axis=2) for label, of in positions.items() if label != reference
               and truth is not None]
    depths_m = [1e-6 * one[4][one[4] > 0] for of in read.values() for one in of if one[4] is not None]
    ends = [rounded_up(mm_per_m * numpy.percentile(numpy.concatenate([numpy.ravel(part) for part in (*parts, [0.0])]),
                                                   99))
            for parts in (apart_m, depths_m)]
    return {"mm_per_m": mm_per_m, "difference_mm": ends[0], "deepest_mm": ends[1], "contact_step_mm": contact_step_mm}


def contact_codes(frames, mm_per_m):
    depths_um = numpy.stack([one[4] for one in frames])
    overlap = numpy.minimum(2 + numpy.rint(1e-6 * mm_per_m * depths_um / contact_step_mm), 255)
    return numpy.where(depths_um > 0, overlap, depths_um < 0).astype("u1")


def grid_over(positions):
    """Lowest corner [m] and step [m] of the grid to which positions are rounded."""
    points = positions.reshape(-1, 3)
    low = points.min(axis=0)
    return low, (points.max(axis=0) - low).max() / position_steps


def codes_of(positions, low, step):
    return numpy.rint((positions - low) / step).astype("<u2")


def differences(codes):
    """The difference of each frame to the previous one, modulo 65536, with the first frame as it is: their low bytes,
    then their high bytes."""
    result = codes.copy()
    result[1:] -= codes[:-1]
    return numpy.stack([result & 255, result >> 8]).astype("u1")


class Block:
    """Arrays in sequence, each at a multiple of four bytes. Equal arrays are stored once, since runs of one body share
    them."""

    def __init__(self):
        self.bytes = bytearray()
        self.places = {}

    def put(self, array):
        packed = numpy.ascontiguousarray(array).tobytes()
        digest = hashlib.sha256(packed).digest()
        if digest not in self.places:
            self.bytes += bytes(-len(self.bytes) % 4)
            self.places[digest] = len(self.bytes)
            self.bytes += packed
        return self.places[digest]


def rows_of(recorded):
    """For each label its rows of metrics.csv in the frames that were written, in the order of the panels: in the order
    of looks.toml."""
    labels = [label for label in looks.in_order(recorded.deformers) if recorded.run.has(*recorded.deformers[label])]
    rows = {label: recorded.run.select(recorded.deformers[label][0], variant=recorded.deformers[label][1])
            for label in labels}
    written = {row["frame"] for label, of in rows.items()
               for row in of if recorded.is_written(label, int(row["frame"]))}
    rows = {label: kept for label, of in rows.items() if (kept := [row for row in of if row["frame"] in written])}
    if not rows:
        raise records.RecordsMissing(f"{recorded.folder / 'frames'}: no frames were written")
    return rows


def title_of(recorded, label):
    """The title of a PBS panel whose stiffness differs from that of plain PBS in the same scene: that stiffness and the
    one of its jiggling zone, as recorded."""
    options = {run["label"]: run.get("options", {}) for run in recorded.run.record["scene"]["runs"]}
    own, plain = options[label], options.get("pbs", {})
    if "k_stretch" not in own or own["k_stretch"] == plain.get("k_stretch"):
        return looks.of(label).name
    zone = f"zone {own['jiggle']['k_stretch']:g}" if own.get("jiggle") else "no zone"
    return f"{looks.of('pbs').name}, k_stretch {own['k_stretch']:g}, {zone}"


def pack_bones(recorded, frames, block):
    """Names, and the place of the posed ends: float32, frame by frame, head and tail [m] of every bone."""
    rows = records.table(recorded.folder / "bones.csv", {"frame", "bone", *recorded_frames.bone_ends})
    of_frame = {}
    for row in rows:
        of_frame.setdefault(int(row["frame"]), []).append([float(row[column]) for column in recorded_frames.bone_ends])
    missing = [frame for frame in frames if frame not in of_frame]
    if missing:
        raise records.RecordsMissing(f"{recorded.folder / 'bones.csv'}: no frame {missing[0]}")
    ends = numpy.array([of_frame[frame] for frame in frames], dtype="<f4")
    names = [row["bone"] for row in rows[:ends.shape[1]]]
    return {"names": names, "ends": block.put(ends)}


def pack_surface(recorded, block):
    """The rendered surface: its triangles, and the tet and weights of each of its points. None for a body without
    one."""
    file = recorded.skin_at_rest()
    if not file:
        return None
    triangles = vtk_to_numpy(rendering.read(file).GetPolys().GetConnectivityArray()).reshape(-1, 3)
    tets, shares = recorded.embedding()
    if triangles.max() >= len(tets):
        raise records.RecordsMissing(f"{recorded.folder / 'embedding.csv'}: {len(tets)} points, but {file.name} "
                                     "has more")
    of_joints = recorded.points_of_joints()  # the tets would draw them elsewhere
    triangles = numpy.array([corners for corners in triangles.tolist() if of_joints.isdisjoint(corners)]).reshape(-1, 3)
    return {"points": len(tets), "triangles": len(triangles), "of_joints": len(of_joints),
            "largest_sum": float(abs(shares).sum(axis=1).max()), "corners": block.put(triangles.astype("<u4")),
            "tets": block.put(tets.astype("<u4")), "shares": block.put(shares.astype("<f4"))}


def last_state(rows, frame):
    """The frame itself, or the last one before it with a row, or the first one."""
    return max((own for own in rows if own <= frame), default=min(rows))


def finite(row, column):
    """None where the cell is empty, missing or not finite, as the errors at the joints of a body without a joint."""
    value = float(row[column]) if row.get(column) else math.nan
    return value if math.isfinite(value) else None


def facts_of(recorded, every):
    """The facts from the run's tables, without its frames. A deformer without a solution in a frame, as a reference
    whose budget left it out, has not reached it."""
    rows = {label: {int(row["frame"]): row for row in of} for label, of in rows_of(recorded).items()}
    first = list(max(rows.values(), key=len).values())[::every]
    frames = [int(row["frame"]) for row in first]
    shown = [{"label": label, "title": title_of(recorded, label), "colour": looks.of(label).color,
              "figures": {column: [finite(of.get(frame, {}), column) for frame in frames] for column in figures},
              "not_reached": [at for at, frame in enumerate(frames) if frame not in of
                              or not records.is_reached(of[frame])],
              "states": [last_state(of, frame) for frame in frames]} for label, of in rows.items()]
    return {"name": recorded.run.name, "title": titles.get(recorded.run.name, recorded.run.name),
            "reference": recorded.run.reference(needed=False),
            "rights": "; ".join(entries.licences_of(recorded.run.record)), "frames": frames,
            "times_s": [float(row["time_s"]) for row in first], "deformers": shown}


def without_broken(facts, positions):
    """The facts without deformers that have a position that is not finite, which are listed under `left_out` with that
    frame."""
    broken = {label: facts["frames"][int(is_finite.argmin())] for label, of in positions.items()
              if not (is_finite := numpy.isfinite(of).all(axis=(1, 2))).all()}
    parts = {is_kept: [of for of in facts["deformers"] if (of["label"] not in broken) == is_kept]
             for is_kept in (True, False)}
    left_out = [{"title": of["title"], "frame": broken[of["label"]]} for of in parts[False]]
    return {**facts, "deformers": parts[True], "left_out": left_out}


def pack_run(recorded, every, block):
    """The header of one run; its arrays are added to the block."""
    facts = facts_of(recorded, every)
    read = {of["label"]: [read_frame(recorded.tets(of["label"], frame)) for frame in of.pop("states")]
            for of in facts["deformers"]}
    positions = {label: numpy.stack([one[0] for one in of]) for label, of in read.items()}
    _, tets, _, rest, _ = next(iter(read.values()))[0]
    facts = without_broken(facts, positions)
    records.need(facts["deformers"], f"{recorded.folder / 'frames'}: every deformer has a position that is not finite: "
                                     "nothing to show")
    low, step = grid_over(numpy.stack([positions[of["label"]] for of in facts["deformers"]]))
    rest_low, rest_step = grid_over(rest)
    bad = {at for of in facts["deformers"] for at in of["not_reached"]}
    good = [at for at in range(len(facts["frames"])) if at not in bad] or [0]
    scales = scales_of(read, {of["label"]: positions[of["label"]][good] for of in facts["deformers"]},
                       facts["reference"], rest)
    for deformer in facts["deformers"]:
        deformer["positions"] = block.put(differences(codes_of(positions[deformer["label"]], low, step)))
        ratios = numpy.stack([one[2] for one in read[deformer["label"]]])
        codes = numpy.where(ratios <= 0, 0, numpy.clip(1 + numpy.rint(ratios * ratio_steps), 1, 255))
        deformer["ratios"] = block.put(codes.astype("u1"))
        if all(one[4] is not None for one in read[deformer["label"]]):
            deformer["contact"] = block.put(contact_codes(read[deformer["label"]], scales["mm_per_m"]))
    return {**facts, **scales, "vertices": len(rest), "tets": len(tets), "low_m": low.tolist(), "step_m": step,
            "rest_low_m": rest_low.tolist(), "rest_step_m": rest_step, "tet_corners": block.put(tets.astype("<u4")),
            "bones": pack_bones(recorded, facts["frames"], block),
            "rest_codes": block.put(codes_of(rest, rest_low, rest_step)), "surface": pack_surface(recorded, block)}


def recorded_runs(results):
    """The runs of the study `frames`, after a check that they are planned, written by their own run and not changed
    since, like the records of a figure, and that all have one revision."""
    found = [recorded_frames.Frames(results, name) for name in titles if (results / "frames" / name).is_dir()]
    records.need(found, f"{results / 'frames'}: no frames on record; the study `frames` writes them")
    files = [f"frames/{recorded.run.name}/{file}" for recorded in found
             for file in ("metrics.csv", "bones.csv", "frames/*.vtu")]
    entries.Entry("viewer", "", "", [], files, "", "R").check(results)
    return found


def pack(recorded, every=1):
    """The header and the compressed block of these runs, with every n-th frame."""
    block = Block()
    runs = [pack_run(one, every, block) for one in recorded]
    return {"schema": 1, "every": every, "ratio_steps": ratio_steps,
            "runs": runs}, gzip.compress(bytes(block.bytes), 9, mtime=0)
