"""Rigs of blocks: two shoes side by side and a closed mouth, which nearly touch at rest as those of artists do, and a
ring.

    block_rigs.write_shoes(path)      # PATH.glb
"""
import numpy

import rig_files

SHOES_GAP, MOUTH_GAP = 0.004, 0.003  # [m]


def surface_of(lines, is_filled):
    """Points, #P x 3, and outward triangles, #F x 3, of the surface of those cells between grid lines whose middles are
    filled."""
    middles = numpy.meshgrid(*[(line[1:] + line[:-1]) / 2 for line in lines], indexing="ij")
    filled = numpy.pad(is_filled(*middles), 1)
    corners, triangles = {}, []
    for cell in numpy.argwhere(filled):
        for axis in range(3):
            for side in (0, 1):
                beside = cell.copy()
                beside[axis] += 2 * side - 1
                if filled[tuple(beside)]:
                    continue
                first = cell - 1
                first[axis] += side
                u, v = numpy.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
                face = [tuple(corner) for corner in (first, first + u, first + u + v, first + v)]
                a, b, c, d = (corners.setdefault(corner, len(corners)) for corner in (face if side else face[::-1]))
                triangles += [(a, b, c), (a, c, d)]
    points = numpy.array([[lines[axis][corner[axis]] for axis in range(3)] for corner in corners])
    return points, numpy.array(triangles)


def lines(*ends, step=0.02):
    """Grid lines through all ends, at most a step apart."""
    parts = [numpy.linspace(a, b, max(2, int(numpy.ceil((b - a) / step - 1e-9)) + 1)) for a, b in zip(ends, ends[1:])]
    return numpy.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def written(path, surface, joints, weights, moving, turns):
    """joints: (name, parent's number, place [m]). The joint with the number `moving` turns by these quaternions within
    a second."""
    gltf = rig_files.Gltf()
    nodes = rig_files.add_joints(gltf, [(*joint, {}) for joint in joints])
    gltf.node(name="body", mesh=rig_files.add_mesh(gltf, *surface, weights, 1.0, False), skin=0)
    rig_files.add_animation(gltf, "Move",
                            [(nodes[moving], "rotation", numpy.linspace(0.0, 1.0, len(turns)), turns, "LINEAR")])
    return rig_files.write_glb(path, *gltf.written())


def ramp(at, begin, end):
    return numpy.clip((at - begin) / (end - begin), 0.0, 1.0)


def write_shoes(path, far_bone=False):
    """Hips with two legs, whose shoes are SHOES_GAP apart. The left leg steps forward. far_bone: the shoes alone, with
    the bone of the right one 1 m above it."""
    inner = SHOES_GAP / 2

    def is_filled(x, y, z):
        side = abs(x)
        hips = (y > 0.8) & (side < 0.15) & (abs(z) < 0.06)
        leg = (y > 0.1) & (side > 0.05) & (side < 0.15) & (abs(z) < 0.06)
        shoe = (y < 0.1) & (side > inner)
        return shoe if far_bone else hips | leg | shoe
    surface = surface_of((lines(-0.15, -0.05, -inner, inner, 0.05, 0.15), lines(0.0, 0.1, 0.8, 1.0, step=0.05),
                          lines(-0.06, 0.06, 0.2)), is_filled)
    x, y, _ = surface[0].T
    leg = 1.0 - ramp(y, 0.75, 0.85)
    weights = numpy.stack([1.0 - leg, leg * (x > 0), leg * (x <= 0)], axis=1)
    left, right = (0.05, 1.05) if far_bone else (0.8, 0.8)
    joints = [("hips", None, (0.0, 0.9, 0.0)), ("leg.L", 0, (0.1, left, 0.0)), ("leg.R", 0, (-0.1, right, 0.0))]
    return written(path, surface, joints, weights, 1, [rig_files.turn((1, 0, 0), -angle) for angle in (0, 15, 30)])


def write_mouth(path):
    """A head on a neck, with a jaw whose teeth are MOUTH_GAP below those of the head. The jaw opens."""
    above = 0.05 + MOUTH_GAP

    def is_filled(x, y, z):
        neck = (y < 0.0) & (z < -0.04) & (abs(x) < 0.05)
        mouth = (y > 0.05) & (y < above) & (z > -0.02)
        return neck | ((y > 0.0) & ~mouth)
    surface = surface_of((lines(-0.07, -0.05, 0.05, 0.07), lines(-0.12, 0.0, 0.05, above, 0.25),
                          lines(-0.1, -0.04, -0.02, 0.1)), is_filled)
    _, y, z = surface[0].T
    lip = ramp(z, -0.02, 0.03)  # at the corner of the mouth both lips move alike
    below = (y <= 0.05) | ((y < 0.0515) & (z < -0.02))
    away = numpy.clip(abs(y - 0.0515) / 0.03, 0.0, 1.0)
    jaw = numpy.where(below, 0.5 + 0.5 * lip + away * (0.5 - 0.5 * lip), (0.5 - 0.5 * lip) * (1.0 - away))
    jaw *= ramp(z, -0.06, -0.02) * ramp(y, -0.05, 0.0)
    neck = (1.0 - ramp(y, -0.03, 0.03)) * (1.0 - jaw)
    weights = numpy.stack([neck, 1.0 - neck - jaw, jaw, 0.0 * jaw], axis=1)
    joints = [("neck", None, (0.0, -0.12, -0.07)), ("head", 0, (0.0, 0.02, -0.07)), ("jaw", 1, (0.0, 0.05, -0.04)),
              ("crown", 1, (0.0, 0.24, 0.0))]
    return written(path, surface, joints, weights, 2, [rig_files.turn((1, 0, 0), angle) for angle in (0, 12, 25)])


def write_ring(path, gap=0.0):
    """A square ring, whose upper half turns. With a gap [m] in its lower half it has no hole."""
    line, middle = lines(-0.2, -0.1, 0.1, 0.2, step=0.05), (-gap / 2, gap / 2) if gap else ()

    def is_filled(x, y, z):
        return (numpy.maximum(abs(x), abs(y)) > 0.1) & ((y > 0) | (abs(x) > gap / 2))
    surface = surface_of((lines(-0.2, -0.1, *middle, 0.1, 0.2, step=0.05), line, lines(-0.05, 0.05, step=0.05)),
                         is_filled)
    above = ramp(surface[0][:, 1], -0.05, 0.05)
    joints = [("root", None, (-0.15, -0.15, 0.0)), ("top", 0, (-0.15, 0.0, 0.0))]
    return written(path, surface, joints, numpy.stack([1.0 - above, above], axis=1), 1,
                   [rig_files.turn((1, 0, 0), a) for a in (0, 20)])
