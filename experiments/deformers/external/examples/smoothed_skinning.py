"""A deformer for pbskin in Python: linear blend skinning, then some steps of Laplacian smoothing of the displacements.

    [[external]]
    name = "smoothed"
    command = ["python3", "smoothed_skinning.py"]
"""
import json
import pathlib
import sys
import time

import numpy

folder = pathlib.Path(sys.argv[-1])
facts = json.loads((folder / "character.json").read_text())
vertices, bones, poses = facts["vertices"], len(facts["bones"]), facts["poses"]
rest = numpy.fromfile(folder / "rest.f64").reshape(vertices, 3)
tets = numpy.fromfile(folder / "tets.i32", dtype="<i4").reshape(-1, 4)
weights = numpy.fromfile(folder / "weights.f64").reshape(vertices, bones)
transforms = numpy.fromfile(folder / "poses.f64").reshape(poses, bones, 3, 4)

pairs = numpy.concatenate([tets[:, [a, b]] for a in range(4) for b in range(4) if a != b])
pairs = numpy.unique(pairs, axis=0)  # each vertex with each of its neighbours
neighbours = numpy.bincount(pairs[:, 0], minlength=vertices)[:, None]


def smoothed(values):
    """The mean over the neighbours."""
    total = numpy.zeros_like(values)
    numpy.add.at(total, pairs[:, 0], values[pairs[:, 1]])
    return total / neighbours


positions, seconds = [], []
for pose in transforms:
    start = time.perf_counter()
    blended = numpy.einsum("vb,bij->vij", weights, pose)
    displacement = numpy.einsum("vij,vj->vi", blended[:, :, :3], rest) + blended[:, :, 3] - rest
    for _ in range(4):
        displacement = smoothed(displacement)
    positions.append(rest + displacement)
    seconds.append(time.perf_counter() - start)
numpy.array(positions).tofile(folder / "positions.f64")
numpy.array(seconds).tofile(folder / "seconds.f64")
