"""Rigged and moving characters of own making, with the traits of rigs that people export: a deer with thin legs, and a
fish whose first frame is far from its bind pose.

    character_rigs.write_thin_walker(path)      # PATH.glb

A body is an implicit surface: capsules that blend into one another, each of which belongs to a bone. The axes are x to
the left, y up and z ahead; lengths are in metres.
"""
import numpy
import vtkmodules.util.numpy_support as numpy_support
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

import rig_files

AHEAD, UP = (1, 0, 0), (0, 1, 0)  # axes about which a limb swings ahead, and about the vertical
RIGHT = numpy.array([-1.0, 1.0, 1.0])  # mirrors a place of the left side


class Figure:
    """Joints and capsules. `joint` and `capsule` take places [m]; a pair of limbs is made on the left side and
    mirrored."""

    def __init__(self):
        self.joints = []    # (name, number of the joint above or None, place)
        self.capsules = []  # (number of the joint, begin, end, radius at the begin, radius at the end)

    def number(self, name):
        return [joint[0] for joint in self.joints].index(name)

    def joint(self, name, above, place, *ends):
        """A joint below another one and its capsules, each (end, radius at the joint, radius at the end). Returns the
        joint's name."""
        self.joints.append((name, None if above is None else self.number(above), numpy.array(place, dtype=float)))
        for end, *radii in ends:
            self.capsule(name, place, end, *radii)
        return name

    def capsule(self, name, begin, end, radius, end_radius):
        self.capsules.append((self.number(name), numpy.array(begin, dtype=float), numpy.array(end, dtype=float), radius,
                              end_radius))

    def pair(self, name, above, place, *ends):
        """The same joint on both sides; `above` may be one of a pair, whose name then ends in .L."""
        for side, sign in (("L", numpy.ones(3)), ("R", RIGHT)):
            parent = above[:-1] + side if above.endswith(".L") else above
            self.joint(f"{name}.{side}", parent, place * sign, *((end * sign, *radii) for end, *radii in ends))
        return f"{name}.L"

    def distances(self, points):
        """Signed distances [m] of points from the surfaces of all capsules, #P x #capsules."""
        return numpy.stack([distance(points, *capsule[1:]) for capsule in self.capsules], axis=1)

    def surface(self, step, blend):
        """Points and outward triangles of the surface on a grid with that step [m]. Capsules blend where both are
        within `blend` [m]."""
        reach = (max(max(radii) for *_, radii in ((capsule[0], capsule[3:]) for capsule in self.capsules)) + blend
                 + 2 * step)
        ends = numpy.array([end for capsule in self.capsules for end in capsule[1:3]])
        first = ends.min(axis=0) - reach
        axes = [first[axis] + step * numpy.arange(int((ends[:, axis].max() + reach - first[axis]) / step) + 1)
                for axis in range(3)]
        field = numpy.full([len(axis) for axis in axes], 1.0)
        for _, begin, end, *radii in self.capsules:
            near = max(radii) + blend + 2 * step
            low, high = numpy.minimum(begin, end) - near, numpy.maximum(begin, end) + near
            box = tuple(slice(*numpy.searchsorted(axis, (low[k], high[k]))) for k, axis in enumerate(axes))
            grid = numpy.stack(numpy.meshgrid(*(axis[part] for axis, part in zip(axes, box)), indexing="ij"), axis=-1)
            field[box] = smooth_minimum(field[box], distance(grid, begin, end, *radii), blend)
        return marched(field + 1e-9, first, step)  # no grid point is on the surface

    def weights(self, points, blend):
        """Weights, #P x #joints: a point belongs to the nearest bone, and within `blend` [m] also to the bones that are
        joined to it."""
        count, away = len(self.joints), numpy.full((len(points), len(self.joints)), numpy.inf)
        for (bone, *_), column in zip(self.capsules, self.distances(points).T):
            away[:, bone] = numpy.minimum(away[:, bone], column)
        above = numpy.array([bone if parent is None else parent for bone, (_, parent, _) in enumerate(self.joints)])
        joined = (above[:, None] == numpy.arange(count)) | (above == numpy.arange(count)[:, None])
        nearest = away.argmin(axis=1)
        near = numpy.clip(1.0 - (away - away.min(axis=1, keepdims=True)) / blend, 0.0, 1.0) ** 2
        near[~joined[nearest]] = 0.0
        near[numpy.arange(len(points)), nearest] = 1.0
        return near / near.sum(axis=1, keepdims=True)


def distance(points, begin, end, radius, end_radius):
    """Signed distance of points, ... x 3, from a capsule whose radius changes evenly."""
    along = end - begin
    share = numpy.clip((points - begin) @ along / max(along @ along, 1e-12), 0.0, 1.0)
    return numpy.linalg.norm(points - begin - share[..., None] * along,
                             axis=-1) - (radius + share * (end_radius - radius))


def smooth_minimum(one, other, width):
    overlap = numpy.maximum(width - abs(one - other), 0.0) / width
    return numpy.minimum(one, other) - 0.25 * width * overlap ** 2


def marched(field, first, step):
    """Points and outward triangles of the surface where the field on a grid is zero; it is negative inside."""
    image = vtkImageData()
    image.SetDimensions(field.shape)
    image.SetOrigin(first)
    image.SetSpacing(step, step, step)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(field.ravel(order="F"), deep=True))
    march = vtkFlyingEdges3D()
    march.SetInputData(image)
    march.SetValue(0, 0.0)
    march.ComputeNormalsOff()
    march.ComputeGradientsOff()
    march.ComputeScalarsOff()
    march.Update()
    points = numpy_support.vtk_to_numpy(march.GetOutput().GetPoints().GetData()).astype(float)
    triangles = numpy_support.vtk_to_numpy(march.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    outward = numpy.einsum("ij,ij->", a, numpy.cross(b, c)) > 0.0
    return points, triangles if outward else triangles[:, ::-1]


def turned(name, axis, degrees):
    """A joint that turns about an axis by these angles, evenly spread over the motion."""
    return name, "rotation", [rig_files.turn(axis, angle) for angle in degrees]


def swung(name, axis, amplitude, phase=0.0, cycles=2, middle=0.0):
    """A joint that swings about an axis: middle + amplitude sin(phase + cycles turns)."""
    return turned(name, axis,
                  middle + amplitude * numpy.sin(phase + 2 * numpy.pi * cycles * numpy.linspace(0.0, 1.0, 33)))


def both(name, *arguments, phase, **options):
    """The same swing on both sides, half a cycle apart."""
    return [swung(f"{name}.{side}", *arguments, phase=phase + shift, **options)
            for side, shift in (("L", 0.0), ("R", numpy.pi))]


def written(path, figure, points, triangles, weights, motion, seconds):
    """weights: #P x #joints. motion: (joint's name, "rotation", values evenly spread)."""
    gltf = rig_files.Gltf()
    nodes = rig_files.add_joints(gltf, [(*joint, {}) for joint in figure.joints])
    gltf.node(name="body", mesh=rig_files.add_mesh(gltf, points, triangles, weights, 1.0, False), skin=0)
    channels = [(nodes[figure.number(name)], channel, numpy.linspace(0.0, seconds, len(values)), values, "LINEAR")
                for name, channel, values in motion]
    rig_files.add_animation(gltf, "Move", channels)
    return rig_files.write_glb(path, *gltf.written())


def add_legs(figure, above, name, hip, radii, foot, bend):
    """Two legs from their hip [m]: radii at hip, knee and ankle; the length of the foot; how far ahead the knee is."""
    hip = numpy.array(hip)
    knee, ankle = hip * (1, 0.52, 1) + (0, 0, bend), hip * (1, 0, 1) + (0, 0.07, 0)
    upper = figure.pair(name + "_upper", above, hip, (knee, radii[0], radii[1]))
    lower = figure.pair(name + "_lower", upper, knee, (ankle, radii[1], radii[2]))
    figure.pair(name + "_foot", lower, ankle, (ankle + (0, -0.03, foot), 1.2 * radii[2], radii[2]))


def trot(amplitude):
    """The diagonal legs swing together."""
    motion = []
    for name, phase in (("front", 0.0), ("hind", numpy.pi)):
        motion += both(name + "_upper", AHEAD, amplitude, phase=phase)
        motion += both(name + "_lower", AHEAD, 0.7 * amplitude, phase=phase + 1.2, middle=0.5 * amplitude)
        motion += both(name + "_foot", AHEAD, 0.5 * amplitude, phase=phase + 2.0)
    return motion


def write_thin_walker(path, seconds=2.0, step=0.008, leg=0.017):
    """A deer of 1.1 m, whose legs (radius `leg` at the ankle [m]) are about three tets thick where the body has 2,000
    vertices."""
    figure = Figure()
    figure.joint("hips", None, (0, 0.72, -0.3), ((0, 0.73, -0.08), 0.1, 0.1))
    figure.joint("chest", "hips", (0, 0.73, -0.05), ((0, 0.72, 0.22), 0.1, 0.115))
    figure.joint("neck", "chest", (0, 0.78, 0.27), ((0, 0.95, 0.38), 0.075, 0.045))
    figure.joint("head", "neck", (0, 0.98, 0.4), ((0, 0.95, 0.55), 0.055, 0.03))
    figure.pair("ear", "head", numpy.array((0.03, 1.03, 0.39)), (numpy.array((0.1, 1.1, 0.37)), 0.02, 0.012))
    figure.joint("tail", "hips", (0, 0.76, -0.4), ((0, 0.68, -0.46), 0.03, 0.02))
    add_legs(figure, "chest", "front", (0.075, 0.64, 0.2), (2.6 * leg, 1.3 * leg, leg), 0.05, -0.01)
    add_legs(figure, "hips", "hind", (0.075, 0.64, -0.3), (3.2 * leg, 1.4 * leg, leg), 0.05, 0.04)
    motion = [*trot(38), swung("neck", AHEAD, 12), swung("head", AHEAD, 10, phase=1.0), swung("tail", UP, 30, cycles=4)]
    points, triangles = figure.surface(step, 0.03)
    return written(path, figure, points, triangles, figure.weights(points, 0.035), motion, seconds)


def write_far_first_pose(path, seconds=2.0, step=0.008, first_deg=165.0):
    """A fish of 0.8 m with side fins of 0.3 m. From the first frame on they are turned over by first_deg, about an axis
    that is nearly along them, and swing a little, and the tail beats. LBS collapses and inverts their roots in all
    frames."""
    figure, above = Figure(), None
    for number, (begin, radii) in enumerate(((0.0, (0.075, 0.11)), (-0.14, (0.11, 0.09)), (-0.28, (0.085, 0.05)),
                                             (-0.42, (0.045, 0.03)))):
        above = figure.joint(f"body.{number}", above, (0, 0, begin), ((0, 0, begin - 0.12), *radii))
    figure.joint("head", "body.0", (0, 0, 0.02), ((0, 0, 0.12), 0.09, 0.055))
    figure.joint("tail", above, (0, 0, -0.54), ((0, 0.11, -0.66), 0.03, 0.018))
    figure.capsule("tail", (0, 0, -0.54), (0, -0.11, -0.66), 0.03, 0.018)
    figure.joint("back_fin", "body.1", (0, 0.1, -0.15), ((0, 0.19, -0.24), 0.026, 0.014))
    root, along, back = numpy.array((0.085, -0.02, 0.0)), numpy.array((0.1, -0.005, 0.1)), numpy.array(
        (0.03, 0.0, -0.03))
    fin = figure.pair("fin", "body.0", root, (root + along, 0.028, 0.025), (root + along + back, 0.028, 0.022))
    figure.pair("fin_tip", fin, root + along, (root + 2.1 * along, 0.025, 0.014),
                (root + 1.9 * along + 1.5 * back, 0.024, 0.014))
    swim = numpy.sin(4 * numpy.pi * numpy.linspace(0.0, 1.0, 33))
    motion = [swung(f"body.{number}", UP, 9 + 3 * number, phase=-0.8 * number) for number in range(1, 4)]
    motion += [swung("tail", UP, 25, phase=-3)]
    motion += [turned(f"fin.{side}", (1.0, -0.05 * sign, sign), sign * (first_deg + 12 * swim))
               for side, sign in (("L", 1), ("R", -1))]
    motion += [turned(f"fin_tip.{side}", (0.0, 0.0, -sign), 25 + 10 * swim) for side, sign in (("L", 1), ("R", -1))]
    points, triangles = figure.surface(step, 0.025)
    return written(path, figure, points, triangles, figure.weights(points, 0.08), motion, seconds)
