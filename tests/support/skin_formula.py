"""The skinning formula of glTF 2.0 (Sec. 3.7.3), from the bytes of a .glb or .gltf file, in double precision: the sum
over the joints of weight x node transform x inverse bind matrix x point. Written from the specification, without
pbskin.

    skin_formula.Model("hero.glb").points("Walk", 0.5)     # all meshes of the scene, #P x 3, in the file's unit
"""
import base64
import json
import os
import struct

import numpy

TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
# The tolerance for another order of operations, relative to the largest coordinate. A point has up to 4 joints with up
# to 6 nodes above each, and a product of two matrices and its use take some 40 operations: fewer than 2^10 results are
# rounded, each by up to 2^-53.
ROUNDED = 2.0 ** -43


def quaternion_matrix(q):
    x, y, z, w = q / numpy.linalg.norm(q)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def slerp(a, b, share):
    a, b = a / numpy.linalg.norm(a), b / numpy.linalg.norm(b)
    cosine = numpy.dot(a, b)
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = numpy.arccos(min(cosine, 1.0))
    if angle < 1e-9:
        return a
    return (numpy.sin((1 - share) * angle) * a + numpy.sin(share * angle) * b) / numpy.sin(angle)


class Model:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        self.folder, self.binary = os.path.dirname(path), None
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            self.document = json.loads(data[20:20 + length])
            if len(data) > 20 + length:
                self.binary = data[28 + length:]
        else:
            self.document = json.loads(data)
        self.buffers = [self.buffer(b) for b in self.document.get("buffers", [])]
        self.nodes = self.document["nodes"]
        self.parent = {child: n for n, node in enumerate(self.nodes) for child in node.get("children", [])}

    def buffer(self, buffer):
        uri = buffer.get("uri")
        if uri is None:
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(self.folder, uri), "rb") as file:
            return file.read()

    def numbers(self, index):
        """The numbers of an accessor, #elements x components."""
        accessor = self.document["accessors"][index]
        dtype, width = numpy.dtype(TYPES[accessor["componentType"]]), COMPONENTS[accessor["type"]]
        view = self.document["bufferViews"][accessor["bufferView"]]
        stride = view.get("byteStride", dtype.itemsize * width)
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = [numpy.frombuffer(self.buffers[view["buffer"]], dtype, width, begin + stride * e)
                for e in range(accessor["count"])]
        numbers = numpy.array(rows, dtype=float).reshape(-1, width)
        if accessor.get("normalized"):
            numbers = numpy.maximum(numbers / numpy.iinfo(dtype).max, -1.0)
        return numbers

    def sampled(self, sampler, time_s, rotation):
        times, values = self.numbers(sampler["input"])[:, 0], self.numbers(sampler["output"])
        kind = sampler.get("interpolation", "LINEAR")
        key = values[1::3] if kind == "CUBICSPLINE" else values
        if time_s <= times[0] or len(times) == 1:
            value = key[0]
        elif time_s >= times[-1]:
            value = key[-1]
        else:
            at = int(numpy.searchsorted(times, time_s, side="right")) - 1
            gap = times[at + 1] - times[at]
            t = (time_s - times[at]) / gap
            if kind == "STEP":
                value = key[at]
            elif kind == "CUBICSPLINE":
                leaving, arriving = values[3 * at + 2], values[3 * at + 3]
                value = ((2 * t**3 - 3 * t**2 + 1) * key[at] + gap * (t**3 - 2 * t**2 + t) * leaving
                         + (-2 * t**3 + 3 * t**2) * key[at + 1] + gap * (t**3 - t**2) * arriving)
            else:
                value = slerp(key[at], key[at + 1], t) if rotation else (1 - t) * key[at] + t * key[at + 1]
        return value

    def local(self, n, moved):
        node = {**self.nodes[n], **moved.get(n, {})}
        if "matrix" in node:
            return numpy.array(node["matrix"], dtype=float).reshape(4, 4).T
        matrix = numpy.eye(4)
        rotation = quaternion_matrix(numpy.array(node.get("rotation", [0, 0, 0, 1]), dtype=float))
        matrix[:3, :3] = rotation * numpy.array(node.get("scale", [1, 1, 1]))
        matrix[:3, 3] = node.get("translation", [0, 0, 0])
        return matrix

    def world(self, n, moved):
        own = self.local(n, moved)
        return self.world(self.parent[n], moved) @ own if n in self.parent else own

    def animation(self, name):
        animations = self.document.get("animations", [])
        if name is None:
            return animations[0]
        return next(a for a in animations if a.get("name") == name)

    def span_s(self, name=None):
        """The times of the first and the last key."""
        times = numpy.concatenate([self.numbers(s["input"])[:, 0] for s in self.animation(name)["samplers"]])
        return times.min(), times.max()

    def moved(self, name, time_s):
        animation = self.animation(name)
        moved = {}
        for channel in animation["channels"]:
            target = channel["target"]
            if "node" in target and target["path"] != "weights":
                rotation = target["path"] == "rotation"
                value = self.sampled(animation["samplers"][channel["sampler"]], time_s, rotation)
                moved.setdefault(target["node"], {})[target["path"]] = value
        return moved

    def scene_nodes(self):
        waiting = list(self.document["scenes"][self.document.get("scene", 0)]["nodes"])
        while waiting:
            n = waiting.pop()
            yield n
            waiting += self.nodes[n].get("children", [])

    def mesh_points(self, n, moved):
        """The points of all triangle primitives of a node's mesh, in the scene, that triangles use; primitives with the
        same attributes share them."""
        node, used = self.nodes[n], {}
        for primitive in self.document["meshes"][node["mesh"]]["primitives"]:
            if primitive.get("mode", 4) in (4, 5, 6):
                used.setdefault(json.dumps(primitive["attributes"], sort_keys=True),
                                (primitive, []))[1].append(self.corners(primitive))
        for primitive, corners in used.values():
            yield self.skinned(node, n, primitive, moved)[numpy.unique(numpy.concatenate(corners))]

    def corners(self, primitive):
        """The points that the triangles of a primitive use."""
        if "indices" in primitive:
            corners = self.numbers(primitive["indices"])[:, 0].astype(int)
        else:
            corners = numpy.arange(self.document["accessors"][primitive["attributes"]["POSITION"]]["count"])
        return corners[:len(corners) // 3 * 3] if primitive.get("mode", 4) == 4 else corners

    def unskinned(self, n, primitive):
        """The points of a primitive before its skin moves them, #P x 3."""
        return self.numbers(primitive["attributes"]["POSITION"])

    def skinned(self, node, n, primitive, moved):
        """The points of a primitive of the mesh of node n, #P x 3."""
        points = self.unskinned(n, primitive)
        points = numpy.hstack([points, numpy.ones((len(points), 1))])
        if "skin" not in node:
            return (points @ self.world(n, moved).T)[:, :3]
        skin = self.document["skins"][node["skin"]]
        inverse = (self.numbers(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
                   if "inverseBindMatrices" in skin \
            else numpy.tile(numpy.eye(4), (len(skin["joints"]), 1, 1)))
        matrices = numpy.array([self.world(joint, moved) @ inverse[j] for j, joint in enumerate(skin["joints"])])
        total, sums = numpy.zeros((len(points), 3)), numpy.zeros(len(points))
        for part in range(8):
            if f"JOINTS_{part}" not in primitive["attributes"]:
                break
            joints = self.numbers(primitive["attributes"][f"JOINTS_{part}"]).astype(int)
            weights = self.numbers(primitive["attributes"][f"WEIGHTS_{part}"])
            for k in range(4):
                total += weights[:, k:k + 1] * numpy.einsum("pij,pj->pi", matrices[joints[:, k]], points)[:, :3]
                sums += weights[:, k]
        return total / sums[:, None]

    def points(self, name, time_s):
        """All meshes in the order of their nodes; time_s None: at rest."""
        moved = self.moved(name, time_s) if time_s is not None else {}
        meshes = [numpy.concatenate(list(self.mesh_points(n, moved))) for n in sorted(self.scene_nodes())
                  if "mesh" in self.nodes[n]]
        return numpy.concatenate(sorted(meshes, key=len, reverse=True))  # pbskin begins with the largest mesh
