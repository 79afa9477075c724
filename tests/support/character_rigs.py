"""Rigged and moving characters of own making, with the traits of rigs that people export: a dancer with hair and a skirt, a dog whose head
is longer than its bone, a deer with thin legs, a slime that stretches, and a fish whose first frame is far from its bind pose.

    character_rigs.write_dancer(path)      # PATH.glb

A body is an implicit surface: capsules that blend into one another, each of which belongs to a bone. The axes are x to the left, y up and
z ahead; lengths are in metres.
"""
import numpy
import vtkmodules.util.numpy_support as numpy_support
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

import rig_files

SKIRT_GAP = 0.004  # between the inside of the dancer's skirt and her thighs [m]
AHEAD, SIDE, UP = (1, 0, 0), (0, 0, 1), (0, 1, 0)  # axes about which a limb swings ahead, to the side, and about the vertical
RIGHT = numpy.array([-1.0, 1.0, 1.0])  # mirrors a place of the left side


class Figure:
    """Joints and capsules. `joint` and `capsule` take places [m]; a pair of limbs is made on the left side and mirrored."""

    def __init__(self):
        self.joints = []    # (name, number of the joint above or None, place)
        self.capsules = []  # (number of the joint, begin, end, radius at the begin, radius at the end)

    def number(self, name):
        return [joint[0] for joint in self.joints].index(name)

    def joint(self, name, above, place, *ends):
        """A joint below another one and its capsules, each (end, radius at the joint, radius at the end). Returns the joint's name."""
        self.joints.append((name, None if above is None else self.number(above), numpy.array(place, dtype=float)))
        for end, *radii in ends:
            self.capsule(name, place, end, *radii)
        return name

    def capsule(self, name, begin, end, radius, end_radius):
        self.capsules.append((self.number(name), numpy.array(begin, dtype=float), numpy.array(end, dtype=float), radius, end_radius))

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
        """Points and outward triangles of the surface on a grid with that step [m]. Capsules blend where both are within `blend` [m]."""
        reach = max(max(radii) for *_, radii in ((capsule[0], capsule[3:]) for capsule in self.capsules)) + blend + 2 * step
        ends = numpy.array([end for capsule in self.capsules for end in capsule[1:3]])
        first = ends.min(axis=0) - reach
        axes = [first[axis] + step * numpy.arange(int((ends[:, axis].max() + reach - first[axis]) / step) + 1) for axis in range(3)]
        field = numpy.full([len(axis) for axis in axes], 1.0)
        for _, begin, end, *radii in self.capsules:
            near = max(radii) + blend + 2 * step
            low, high = numpy.minimum(begin, end) - near, numpy.maximum(begin, end) + near
            box = tuple(slice(*numpy.searchsorted(axis, (low[k], high[k]))) for k, axis in enumerate(axes))
            grid = numpy.stack(numpy.meshgrid(*(axis[part] for axis, part in zip(axes, box)), indexing="ij"), axis=-1)
            field[box] = smooth_minimum(field[box], distance(grid, begin, end, *radii), blend)
        return marched(field + 1e-9, first, step)  # no grid point is on the surface

    def weights(self, points, blend):
        """Weights, #P x #joints: a point belongs to the nearest bone, and within `blend` [m] also to the bones that are joined to it."""
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
    return numpy.linalg.norm(points - begin - share[..., None] * along, axis=-1) - (radius + share * (end_radius - radius))


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


def swung(name, axis, amplitude, phase=0.0, cycles=2, middle=0.0, keys=33):
    """A joint that swings about an axis: middle + amplitude sin(phase + cycles turns)."""
    return turned(name, axis, middle + amplitude * numpy.sin(phase + 2 * numpy.pi * cycles * numpy.linspace(0.0, 1.0, keys)))


def both(name, *arguments, opposite=True, **options):
    """The same swing on both sides: half a cycle apart, or at the same time."""
    shift = numpy.pi if opposite else 0.0
    phase = options.pop("phase", 0.0)
    return [swung(name + ".L", *arguments, phase=phase, **options), swung(name + ".R", *arguments, phase=phase + shift, **options)]


def written(path, figure, parts, motion, seconds):
    """parts: (points, triangles, weights #P x #joints). motion: (joint's name, rotation or translation, values evenly spread)."""
    gltf = rig_files.Gltf()
    nodes = rig_files.add_joints(gltf, [(*joint, {}) for joint in figure.joints])
    for number, part in enumerate(parts):
        gltf.node(name=f"part_{number}", mesh=rig_files.add_mesh(gltf, *part, 1.0, False), skin=0)
    channels = [(nodes[figure.number(name)], channel, numpy.linspace(0.0, seconds, len(values)), values, "LINEAR")
                for name, channel, values in motion]
    rig_files.add_animation(gltf, "Move", channels)
    return rig_files.write_glb(path, *gltf.written())


def moved(figure, name, shifts):
    """A joint that moves relative to the one above it by these shifts [m]."""
    _, above, place = figure.joints[figure.number(name)]
    rest = place - (0.0 if above is None else figure.joints[above][2])
    return name, "translation", [rest + shift for shift in shifts]


# --- the dancer ---

SKIRT_CHAINS, SKIRT_JOINTS = 7, 3
SKIRT_TOP, SKIRT_STEP = 0.92, 0.14  # height of the first joints of the chains, and the length of their bones [m]


def stadium(angle, radius, half):
    """The point of the outline of a band of that radius around the segment from -half to half on x, in the direction of the angle."""
    x, z = numpy.cos(angle), numpy.sin(angle)
    centre = half * numpy.tanh(4.0 * x)
    return centre + radius * x, radius * z


def skirt_radius(height):
    """Of the inside of the skirt: SKIRT_GAP more than the thigh at its top, and wider below [m]."""
    return 0.082 + SKIRT_GAP + 0.30 * numpy.maximum(0.86 - height, 0.0)


def skirt(figure, rings=22, sides=56, thickness=0.026):
    """A closed shell around both thighs, and the weights of its chains: two neighbouring chains and two joints of each."""
    heights = numpy.linspace(SKIRT_TOP + 0.03, SKIRT_TOP - SKIRT_JOINTS * SKIRT_STEP, rings)
    angles = 2 * numpy.pi * numpy.arange(sides) / sides
    profile = [(height, 0.0) for height in heights[::-1]] + [(height, thickness) for height in heights]  # up the inside, down the outside
    points = numpy.array([(x, height, z) for height, wall in profile
                          for x, z in [stadium(angle, skirt_radius(height) + wall, 0.085) for angle in angles]])
    triangles = []
    for ring in range(len(profile)):
        below, beyond = ring * sides, (ring + 1) % len(profile) * sides
        for side in range(sides):
            after = (side + 1) % sides
            triangles += [(below + side, beyond + side, below + after), (below + after, beyond + side, beyond + after)]
    triangles = numpy.array(triangles)
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    if numpy.einsum("ij,ij->", a, numpy.cross(b, c)) < 0.0:
        triangles = triangles[:, ::-1]
    weights = numpy.zeros((len(points), len(figure.joints)))
    level = numpy.clip((SKIRT_TOP - points[:, 1]) / SKIRT_STEP + 0.5, 0.0, SKIRT_JOINTS)  # 0: the hips, 1: the first joint of a chain
    place = numpy.tile(angles, len(profile)) * SKIRT_CHAINS / (2 * numpy.pi)
    for row, (height, chain) in enumerate(zip(level, place)):
        for joint, share in ((int(height), 1.0 - height % 1.0), (min(int(height) + 1, SKIRT_JOINTS), height % 1.0)):
            for number, part in ((int(chain), 1.0 - chain % 1.0), (int(chain) + 1, chain % 1.0)):
                name = f"skirt.{number % SKIRT_CHAINS}.{joint - 1}" if joint else "hips"
                weights[row, figure.number(name)] += share * part
    return points, triangles, weights


def dancer():
    """1.7 m tall, with 52 joints."""
    figure = Figure()
    figure.joint("hips", None, (0, 0.95, 0), ((0, 1.08, 0), 0.115, 0.1))
    figure.capsule("hips", (-0.07, 0.92, 0), (0.07, 0.92, 0), 0.09, 0.09)
    figure.joint("spine", "hips", (0, 1.08, 0), ((0, 1.22, 0), 0.1, 0.1))
    figure.joint("chest", "spine", (0, 1.22, 0), ((0, 1.38, 0), 0.11, 0.08))
    figure.capsule("chest", (-0.1, 1.33, 0), (0.1, 1.33, 0), 0.075, 0.075)
    figure.joint("neck", "chest", (0, 1.42, 0), ((0, 1.52, 0), 0.045, 0.045))
    figure.joint("head", "neck", (0, 1.52, 0.0), ((0, 1.6, 0.015), 0.075, 0.095))
    for side, sign in (("L", 1), ("R", -1)):  # two plaits behind the ears
        above = "head"
        for number in range(3):
            top = numpy.array([sign * (0.1 + 0.01 * number), 1.62 - 0.12 * number, -0.07 - 0.015 * number])
            end = top + [sign * 0.01, -0.12, -0.015]
            above = figure.joint(f"hair.{side}.{number}", above, top, (end, 0.03 - 0.003 * number, 0.027 - 0.003 * number))
    shoulder = figure.pair("shoulder", "chest", numpy.array((0.06, 1.37, 0)), (numpy.array((0.16, 1.38, 0)), 0.05, 0.055))
    upper = figure.pair("upper_arm", shoulder, numpy.array((0.17, 1.38, 0)), (numpy.array((0.44, 1.38, 0)), 0.048, 0.038))
    lower = figure.pair("lower_arm", upper, numpy.array((0.44, 1.38, 0)), (numpy.array((0.67, 1.38, 0)), 0.037, 0.027))
    hand = figure.pair("hand", lower, numpy.array((0.67, 1.38, 0)), (numpy.array((0.76, 1.38, 0.018)), 0.026, 0.019),
                       (numpy.array((0.76, 1.38, -0.018)), 0.026, 0.019))
    for finger, root, tip in (("thumb", (0.70, 1.38, 0.03), (0.75, 1.37, 0.075)), ("index", (0.77, 1.38, 0.03), (0.85, 1.38, 0.04)),
                              ("fingers", (0.77, 1.38, -0.025), (0.86, 1.38, -0.03))):
        figure.pair(finger, hand, numpy.array(root), (numpy.array(tip), 0.016, 0.015))
    thigh = figure.pair("thigh", "hips", numpy.array((0.085, 0.9, 0)), (numpy.array((0.085, 0.5, 0)), 0.082, 0.055))
    shin = figure.pair("shin", thigh, numpy.array((0.085, 0.5, 0)), (numpy.array((0.085, 0.1, -0.01)), 0.055, 0.036))
    figure.pair("foot", shin, numpy.array((0.085, 0.09, -0.01)), (numpy.array((0.09, 0.04, 0.15)), 0.042, 0.03))
    for chain in range(SKIRT_CHAINS):
        above = "hips"
        for number in range(SKIRT_JOINTS):
            height = SKIRT_TOP - number * SKIRT_STEP
            x, z = stadium(2 * numpy.pi * chain / SKIRT_CHAINS, skirt_radius(height) + 0.013, 0.085)
            above = figure.joint(f"skirt.{chain}.{number}", above, (x, height, z))
    return figure


def write_dancer(path, seconds=3.0, step=0.01):
    """A dancer with two plaits and a skirt of 7 chains of joints, SKIRT_GAP from her thighs. Legs and arms turn up to 90 degrees."""
    figure = dancer()
    body = figure.surface(step, 0.03)
    motion = [moved(figure, "hips", [(0.0, -0.03 * abs(numpy.sin(2 * numpy.pi * t)), 0.0) for t in numpy.linspace(0, 1, 33)]),
              swung("spine", UP, 18), swung("chest", SIDE, 8), swung("head", UP, 20, phase=1.0),
              swung("upper_arm.L", SIDE, 45, middle=-35, phase=-0.9), swung("upper_arm.R", SIDE, 45, middle=35, phase=0.5),
              *both("lower_arm", UP, 40, opposite=False, cycles=3), *both("hand", SIDE, 25), *both("fingers", SIDE, 30),
              turned("thigh.L", AHEAD, [0, -30, -90, -60, -5, 15, 0, -25, 0]), turned("shin.L", AHEAD, [0, 40, 85, 30, 5, 25, 0, 30, 0]),
              turned("thigh.R", AHEAD, [0, 15, 10, 0, -25, -80, -40, 0, 0]), turned("shin.R", AHEAD, [0, 10, 15, 5, 35, 80, 35, 0, 0]),
              *both("foot", AHEAD, 20)]
    for chain in range(SKIRT_CHAINS):
        angle = 2 * numpy.pi * chain / SKIRT_CHAINS
        outward = (-numpy.sin(angle), 0.0, numpy.cos(angle))  # about this axis a chain lifts away from the legs
        for number, share in enumerate((11.0, 8.0, 6.0)):
            motion.append(swung(f"skirt.{chain}.{number}", outward, share, middle=share, phase=0.8 * chain - 1.6, cycles=3))
    for hair in ("hair.L", "hair.R"):
        motion += [swung(f"{hair}.{number}", AHEAD, 14, phase=-0.6 * number, cycles=3) for number in range(3)]
    return written(path, figure, [(*body, figure.weights(body[0], 0.04)), skirt(figure)], motion, seconds)


# --- animals ---


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


def write_long_head(path, seconds=2.0, step=0.01):
    """A dog of 0.9 m. Its head bone ends at the ears, 0.05 m from its joint, and its muzzle reaches 0.25 m beyond; its feet hang on one
    bone each. Head and feet turn quickly."""
    figure = Figure()
    figure.joint("hips", None, (0, 0.5, -0.3), ((0, 0.5, -0.1), 0.095, 0.095))
    figure.joint("chest", "hips", (0, 0.5, -0.05), ((0, 0.5, 0.2), 0.1, 0.12))
    figure.joint("neck", "chest", (0, 0.54, 0.25), ((0, 0.68, 0.34), 0.085, 0.06))
    figure.joint("head", "neck", (0, 0.7, 0.36), ((0, 0.73, 0.41), 0.075, 0.08))
    figure.capsule("head", (0, 0.72, 0.45), (0, 0.68, 0.63), 0.055, 0.038)
    figure.pair("ear", "head", numpy.array((0.05, 0.77, 0.37)), (numpy.array((0.1, 0.72, 0.35)), 0.026, 0.02))
    above = "hips"
    for number in range(3):
        begin = numpy.array((0, 0.54 + 0.06 * number, -0.38 - 0.09 * number))
        above = figure.joint(f"tail.{number}", above, begin, (begin + (0, 0.06, -0.09), 0.028 - 0.004 * number, 0.024 - 0.004 * number))
    add_legs(figure, "chest", "front", (0.08, 0.43, 0.2), (0.06, 0.042, 0.034), 0.08, -0.015)
    add_legs(figure, "hips", "hind", (0.08, 0.43, -0.28), (0.07, 0.042, 0.034), 0.08, 0.03)
    motion = [*trot(28), swung("neck", AHEAD, 20), swung("head", UP, 40, cycles=3), *both("ear", SIDE, 25, cycles=4),
              swung("chest", UP, 8), *[swung(f"tail.{number}", UP, 25, phase=-0.7 * number, cycles=4) for number in range(3)]]
    points, triangles = figure.surface(step, 0.03)
    return written(path, figure, [(points, triangles, figure.weights(points, 0.035))], motion, seconds)


def write_thin_walker(path, seconds=2.0, step=0.008, leg=0.017):
    """A deer of 1.1 m, whose legs (radius `leg` at the ankle [m]) are about three tets thick where the body has 2,000 vertices."""
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
    return written(path, figure, [(points, triangles, figure.weights(points, 0.035))], motion, seconds)


def write_slime(path, seconds=2.0, step=0.012, stretch=0.5):
    """A slime of 0.5 m. Its joints move apart by up to that share of their distance and together by half as much."""
    figure = Figure()
    figure.joint("root", None, (0, 0.05, 0), ((0, 0.1, 0), 0.2, 0.19))
    figure.joint("middle", "root", (0, 0.2, 0), ((0, 0.22, 0), 0.17, 0.15))
    figure.joint("top", "middle", (0, 0.35, 0), ((0, 0.4, 0), 0.1, 0.05))
    figure.pair("lobe", "root", numpy.array((0.15, 0.08, 0)), (numpy.array((0.24, 0.06, 0.05)), 0.09, 0.06))
    wave = numpy.sin(4 * numpy.pi * numpy.linspace(0.0, 1.0, 33))
    change = numpy.where(wave > 0, stretch * wave, 0.5 * stretch * wave)
    motion = [moved(figure, name, 0.15 * change[:, None] * numpy.array(UP)) for name in ("middle", "top")]
    motion += [moved(figure, f"lobe.{side}", change[::-1, None] * numpy.array((sign * 0.15, 0.03, 0)))
               for side, sign in (("L", 1), ("R", -1))]
    motion += [swung("top", SIDE, 15)]
    points, triangles = figure.surface(step, 0.06)
    return written(path, figure, [(points, triangles, figure.weights(points, 0.12))], motion, seconds)


def write_far_first_pose(path, seconds=2.0, step=0.008, first_deg=165.0):
    """A fish of 0.8 m with side fins of 0.3 m. From the first frame on they are turned over by first_deg, about an axis that is nearly
    along them, and swing a little, and the tail beats. LBS collapses and inverts their roots in all frames."""
    figure, above = Figure(), None
    for number, (begin, radii) in enumerate(((0.0, (0.075, 0.11)), (-0.14, (0.11, 0.09)), (-0.28, (0.085, 0.05)), (-0.42, (0.045, 0.03)))):
        above = figure.joint(f"body.{number}", above, (0, 0, begin), ((0, 0, begin - 0.12), *radii))
    figure.joint("head", "body.0", (0, 0, 0.02), ((0, 0, 0.12), 0.09, 0.055))
    figure.joint("tail", above, (0, 0, -0.54), ((0, 0.11, -0.66), 0.03, 0.018))
    figure.capsule("tail", (0, 0, -0.54), (0, -0.11, -0.66), 0.03, 0.018)
    figure.joint("back_fin", "body.1", (0, 0.1, -0.15), ((0, 0.19, -0.24), 0.026, 0.014))
    root, along, back = numpy.array((0.085, -0.02, 0.0)), numpy.array((0.1, -0.005, 0.1)), numpy.array((0.03, 0.0, -0.03))
    fin = figure.pair("fin", "body.0", root, (root + along, 0.028, 0.025), (root + along + back, 0.028, 0.022))
    figure.pair("fin_tip", fin, root + along, (root + 2.1 * along, 0.025, 0.014), (root + 1.9 * along + 1.5 * back, 0.024, 0.014))
    swim = numpy.sin(4 * numpy.pi * numpy.linspace(0.0, 1.0, 33))
    motion = [swung(f"body.{number}", UP, 9 + 3 * number, phase=-0.8 * number) for number in range(1, 4)]
    motion += [swung("tail", UP, 25, phase=-3)]
    motion += [turned(f"fin.{side}", (1.0, -0.05 * sign, sign), sign * (first_deg + 12 * swim)) for side, sign in (("L", 1), ("R", -1))]
    motion += [turned(f"fin_tip.{side}", (0.0, 0.0, -sign), 25 + 10 * swim) for side, sign in (("L", 1), ("R", -1))]
    points, triangles = figure.surface(step, 0.025)
    return written(path, figure, [(points, triangles, figure.weights(points, 0.08))], motion, seconds)


WRITERS = {"dancer": write_dancer, "long_head": write_long_head, "thin_walker": write_thin_walker, "slime": write_slime,
           "far_first_pose": write_far_first_pose}
