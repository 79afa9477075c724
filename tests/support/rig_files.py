"""Rigged glTF files with the difficulties that rigs from outside have, made of one tube with three joints: root, elbow
and tip. The skinning that the file format defines is computed by skin_formula.py, without pbskin.

    rig_files.write("scaled_container", path)      # PATH.glb
"""
import base64
import json
import math
import pathlib
import struct
import tomllib

import numpy

# The sizes of the tube along x [m]; the meshing of a thicker or thinner one takes longer.
LENGTH, RADIUS, RINGS, SIDES = 1.0, 0.045, 25, 16
JOINTS = ("root", "elbow", "tip")
PLACES = ((0.0, 0.0, 0.0), (0.45, 0.0, 0.0), (0.8, 0.0, 0.0))
FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5121, 5123, 5125


def tube(begin=0.0, end=LENGTH):
    """Points, #P x 3, and outward triangles, #F x 3, of a closed tube."""
    angles = [2 * math.pi * side / SIDES for side in range(SIDES)]
    rings = [(begin + (end - begin) * ring / (RINGS - 1), RADIUS * math.cos(angle), RADIUS * math.sin(angle))
             for ring in range(RINGS) for angle in angles]
    points = [(begin - 0.3 * RADIUS, 0.0, 0.0), *rings, (end + 0.3 * RADIUS, 0.0, 0.0)]
    at = lambda ring, side: 1 + ring * SIDES + side % SIDES
    triangles = []
    for side in range(SIDES):
        triangles += [(0, at(0, side + 1), at(0, side)), (len(points) - 1, at(RINGS - 1, side),
                                                          at(RINGS - 1, side + 1))]
        for ring in range(RINGS - 1):
            triangles += [(at(ring, side), at(ring, side + 1), at(ring + 1, side)),
                          (at(ring + 1, side), at(ring, side + 1), at(ring + 1, side + 1))]
    return numpy.array(points), numpy.array(triangles)


def weights_of(points):
    """Smooth weights of the joints, #P x 3; the leaf joint `tip` moves the end of the tube."""
    step = lambda at, width: numpy.clip((points[:, 0] - at) / width + 0.5, 0.0, 1.0)
    elbow, tip = step(PLACES[1][0], 0.2), step(PLACES[2][0], 0.15)
    return numpy.stack([1.0 - elbow, elbow * (1.0 - tip), elbow * tip], axis=1)


def turn(axis, degrees):
    """A quaternion x, y, z, w."""
    half = math.radians(degrees) / 2
    return [*(math.sin(half) * numpy.array(axis, dtype=float) / numpy.linalg.norm(axis)), math.cos(half)]


def glb(document, data, version=2, json_length=None, length=None):
    """The bytes of a .glb file, with the lengths that it states; both parts are filled up to a multiple of four
    bytes."""
    text = json.dumps(document).encode()
    text, data = text + b" " * (-len(text) % 4), bytes(data) + bytes(-len(data) % 4)
    chunks = struct.pack("<I4s", len(text) if json_length is None else json_length, b"JSON") + text
    chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", version, 12 + len(chunks) if length is None else length) + chunks


def gltf(document, data):
    """The text of a .gltf file that contains its buffer, unless the buffer has another address."""
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps({**document, "buffers": [{"uri": uri, **buffer} for buffer in document["buffers"]]})


class Gltf:
    """A glTF document whose numbers are in one buffer."""

    def __init__(self):
        self.bytes = bytearray()
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                         "skins": [], "animations": [], "accessors": [], "bufferViews": []}

    def put(self, numbers, kind, component, normalized=False):
        """The index of a new accessor."""
        types = {FLOAT: "<f4", UNSIGNED_BYTE: "u1", UNSIGNED_SHORT: "<u2", UNSIGNED_INT: "<u4"}
        array = numpy.ascontiguousarray(numpy.asarray(numbers).astype(types[component]))
        self.bytes += bytes(-len(self.bytes) % 4)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": array.nbytes})
        self.bytes += array.tobytes()
        accessor = {"bufferView": len(self.document["bufferViews"]) - 1, "componentType": component,
                    "count": len(array), "type": kind}
        if normalized:
            accessor["normalized"] = True
        if kind == "VEC3" and component == FLOAT:
            accessor.update(min=array.min(axis=0).tolist(), max=array.max(axis=0).tolist())
        if kind == "SCALAR" and component == FLOAT:
            accessor.update(min=[float(array.min())], max=[float(array.max())])
        self.document["accessors"].append(accessor)
        return len(self.document["accessors"]) - 1

    def node(self, parent=None, **members):
        """The index of a new node, below another one or at the top of the scene."""
        nodes = self.document["nodes"]
        nodes.append(members)
        above = self.document["scenes"][0]["nodes"] if parent is None else nodes[parent].setdefault("children", [])
        above.append(len(nodes) - 1)
        return len(nodes) - 1

    def written(self):
        """The document and the bytes of its buffer."""
        document = {key: value for key, value in self.document.items() if value != []}
        return {**document, "buffers": [{"byteLength": len(self.bytes)}]}, self.bytes


def add_joints(gltf, joints, parent=None, unit=1.0):
    """The nodes of joints, each (name, number of the joint above or None, place [m], further members), and their skin.
    The joints without one above are below the node `parent`."""
    places, nodes = numpy.array([place for _, _, place, _ in joints]), []
    for place, (name, above, _, members) in zip(places, joints):
        shift, below = (place, parent) if above is None else (place - places[above], nodes[above])
        nodes.append(gltf.node(below, name=name, translation=(shift / unit).tolist(), **members))
    # inverse, column by column.
    bind = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, *(0.0 - place / unit), 1] for place in places]
    gltf.document["skins"].append({"joints": nodes, "inverseBindMatrices": gltf.put(bind, "MAT4", FLOAT)})
    return nodes


def quantised(weights):
    """Weights as bytes that sum to 255."""
    codes = numpy.rint(weights * 255).astype(int)
    codes[numpy.arange(len(codes)), codes.argmax(axis=1)] += 255 - codes.sum(axis=1)
    return codes


def add_mesh(gltf, points, triangles, weights, unit, compact):
    """A mesh with its skin weights, #P x #joints, of which the four largest of a point are kept; compact: as bytes and
    shorts."""
    count = weights.shape[1]
    if count > 4:
        joints = numpy.argsort(-weights, axis=1, kind="stable")[:, :4]
        weights = numpy.take_along_axis(weights, joints, axis=1)
        weights = weights / weights.sum(axis=1, keepdims=True)
    else:
        weights = numpy.pad(weights, ((0, 0), (0, 4 - count)))
        joints = numpy.tile([*range(count), *[0] * (4 - count)], (len(points), 1))
    attributes = {"POSITION": gltf.put(points / unit, "VEC3", FLOAT)}
    if compact:
        attributes["WEIGHTS_0"] = gltf.put(quantised(weights), "VEC4", UNSIGNED_BYTE, normalized=True)
        attributes["JOINTS_0"] = gltf.put(joints, "VEC4", UNSIGNED_SHORT)
    else:
        attributes["WEIGHTS_0"] = gltf.put(weights, "VEC4", FLOAT)
        attributes["JOINTS_0"] = gltf.put(joints, "VEC4", UNSIGNED_BYTE)
    indices = gltf.put(triangles.reshape(-1, 1), "SCALAR", UNSIGNED_SHORT if compact else UNSIGNED_INT)
    gltf.document["meshes"].append({"name": "tube", "primitives": [{"attributes": attributes, "indices": indices}]})
    return len(gltf.document["meshes"]) - 1


def add_bead(gltf, unit):
    """A bead of 8 mm on the axis of the tube, far from its skin, which alone follows the tip."""
    points, triangles = tube()
    points = 0.008 * points + numpy.array([0.6 * LENGTH, 0.0, 0.0])
    mesh = add_mesh(gltf, points, triangles, numpy.tile([0.0, 0.0, 1.0], (len(points), 1)), unit, False)
    gltf.node(name="bead", mesh=mesh, skin=0)


def add_animation(gltf, name, channels):
    """channels: (node, path, times, values, interpolation)."""
    samplers, targets = [], []
    for node, path, times, values, interpolation in channels:
        kind = "VEC4" if path == "rotation" else "VEC3"
        samplers.append({"input": gltf.put(numpy.array(times).reshape(-1, 1), "SCALAR", FLOAT),
                         "output": gltf.put(values, kind, FLOAT), "interpolation": interpolation})
        targets.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    gltf.document["animations"].append({"name": name, "samplers": samplers, "channels": targets})


def bend(gltf, joints, first_deg=0.0):
    """An animation that bends the elbow by 70 degrees and the tip by 40, and moves the root."""
    times = [0.0, 0.5, 1.0]
    add_animation(gltf, "Bend", [
        (joints[1], "rotation", times, [turn((0, 0, 1), first_deg), turn((0, 0, 1), 35), turn((0, 0, 1), 70)],
         "LINEAR"),
        (joints[2], "rotation", times, [turn((0, 1, 0), 0), turn((0, 1, 0), -20), turn((0, 1, 0), -40)], "LINEAR")])


def rig(containers=(), unit=1.0, compact=False, halves=1, rest_deg=0.0, mesh_name="body", animations=("Bend",),
        extra=(), shifted_m=(0.0, 0.0, 0.0), first_deg=None, tiny_tip=False, on_ground=False, one_joint=False,
        surface=None):
    """The document and the bytes of the buffer of a glTF file.

    containers: transforms of the nodes above the root joint, outermost first. unit: metres per unit of the points and
    joints. rest_deg: angle of the elbow in the file's rest pose, which then is not the bind pose. extra: further
    animations, as add_animation takes them. shifted_m: distance of the joints from the tube. first_deg: angle of the
    elbow in the first frame. tiny_tip: the tip
    moves a bead inside the tube alone. on_ground: the root is below a joint `ground`, 0.5 m under the tube, which has a
    hundredth of its weight. one_joint: the root alone, which the animation Sway turns. surface: points and triangles in
    place of the tube.
    """
    gltf, parent = Gltf(), None
    for name, members in containers:
        parent = gltf.node(parent, name=name, **members)
    names, places = JOINTS[:1] if one_joint else JOINTS, numpy.array(PLACES) + shifted_m
    if on_ground:
        names, places = ("ground", *names), numpy.vstack([places[:1] - [0.0, 0.5, 0.0], places])
    members = {"elbow": {"rotation": turn((0, 0, 1), rest_deg)}} if rest_deg else {}
    joints = add_joints(gltf, [(name, number - 1 if number else None, place, members.get(name, {}))
                               for number, (name, place) in enumerate(zip(names, places))], parent, unit)
    for half in range(halves):
        begin, end = LENGTH * half / halves, LENGTH * (half + 1) / halves
        overlap = 0.05 if halves > 1 else 0.0
        points, triangles = surface or tube(begin - overlap * (half > 0), end)
        weights = weights_of(points)
        if tiny_tip:  # the elbow has the weights of the tip
            weights = numpy.stack([weights[:, 0], weights[:, 1] + weights[:, 2], numpy.zeros(len(weights))], axis=1)
        if on_ground:
            weights = numpy.hstack([0.01 * weights[:, :1], 0.99 * weights[:, :1], weights[:, 1:]])
        if one_joint:
            weights = numpy.ones((len(points), 1))
        mesh = add_mesh(gltf, points, triangles, weights, unit, compact)
        gltf.node(name=mesh_name, mesh=mesh, skin=0)
    if tiny_tip:
        add_bead(gltf, unit)
    if on_ground:
        joints = joints[1:]  # those that animations move
    if one_joint:
        add_animation(gltf, "Sway", [(joints[0], "rotation", [0.0, 1.0], [turn((0, 0, 1), 0), turn((0, 0, 1), 70)],
                                      "LINEAR")])
    for name in () if one_joint else animations:
        if name == "Bend":
            bend(gltf, joints, rest_deg if first_deg is None else first_deg)
        if name == "Twist":
            add_animation(gltf, "Twist", [(joints[1], "rotation", [0.0, 1.0], [turn((1, 0, 0), 0), turn((1, 0, 0), 90)],
                                           "LINEAR")])
        if name == "Spline":
            still = [0.0, 0.0, 0.0, 0.0]
            add_animation(gltf, "Spline", [
                (joints[1], "rotation", [0.0, 1.0], [still, turn((0, 0, 1), 0), still, still, turn((0, 0, 1), 60),
                                                     still], "CUBICSPLINE"),
                (joints[0], "translation", [0.0, 0.6], [[0, 0, 0], [0, 0.3 / unit, 0]], "STEP")])
    for name, channels in extra:
        add_animation(gltf, name, [(joints[joint], *channel) for joint, *channel in channels])
    return gltf.written()


VARIANTS = tomllib.loads(pathlib.Path(__file__).with_name("rig_variants.toml").read_text())


def write_glb(path, document, data):
    pathlib.Path(path).write_bytes(glb(document, data))
    return path


def write(variant, path, **options):
    return write_glb(path, *rig(**{**VARIANTS[variant], **options}))
