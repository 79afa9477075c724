"""The skinning formula of FBX, from the bytes of a binary file, in double precision: the sum over the clusters of
weight x transform of the link x `Transform` of the cluster x point, divided by the sum of the weights. It covers what
exporters such as Blender's write: Euler angles in the order xyz without pivots, and linear curves. Written from the
format, without pbskin.

    fbx_formula.Model("hero.fbx").points(None, 0.5)     # all meshes, #P x 3, in the file's unit
"""
import struct
import zlib

import numpy

TICKS_PER_S = 46186158000
SCALARS = {"Y": "<h", "C": "<?", "I": "<i", "F": "<f", "D": "<d", "L": "<q"}
ARRAYS = {"f": "<f4", "d": "<f8", "l": "<i8", "i": "<i4", "b": "<i1"}
LINEAR = 4  # in KeyAttrFlags


def read_value(data, at):
    kind = chr(data[at])
    if kind in SCALARS:
        return struct.unpack_from(SCALARS[kind], data, at + 1)[0], at + 1 + struct.calcsize(SCALARS[kind])
    if kind in "SR":
        length = struct.unpack_from("<I", data, at + 1)[0]
        return data[at + 5:at + 5 + length].decode("latin-1"), at + 5 + length
    count, is_compressed, size = struct.unpack_from("<III", data, at + 1)
    array = data[at + 13:at + 13 + size]
    return numpy.frombuffer(zlib.decompress(array) if is_compressed else array, ARRAYS[kind], count), at + 13 + size


class Record:
    """A record of the file: its values and its records."""

    def __init__(self, name):
        self.name, self.values, self.records = name, [], []

    def all(self, name):
        return [record for record in self.records if record.name == name]

    def one(self, name):
        return self.all(name)[0]

    def properties(self):
        return {p.values[0]: p.values[4:] for group in self.all("Properties70") for p in group.all("P")}


def read_records(data, at, end):
    header = "<III" if struct.unpack_from("<I", data, 23)[0] < 7500 else "<QQQ"
    records = []
    while at < end:
        record_end, count, _ = struct.unpack_from(header, data, at)
        if record_end == 0:
            break
        at += struct.calcsize(header)
        record = Record(data[at + 1:at + 1 + data[at]].decode())
        at += 1 + data[at]
        for _ in range(count):
            value, at = read_value(data, at)
            record.values.append(value)
        record.records = read_records(data, at, record_end)
        records.append(record)
        at = record_end
    return records


def euler_matrix(degrees):
    (cx, cy, cz), (sx, sy, sz) = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    about_x = numpy.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = numpy.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = numpy.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


class Model:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        assert data.startswith(b"Kaydara FBX Binary"), "expected a binary FBX file"
        self.file = Record("file")
        self.file.records = read_records(data, 27, len(data))
        self.objects = {record.values[0]: record for record in self.file.one("Objects").records}
        self.above, self.below = {}, {}
        for connection in self.file.one("Connections").all("C"):
            kind, below, above = connection.values[:3]
            label = connection.values[3] if kind == "OP" else ""
            self.above.setdefault(below, []).append((above, label))
            self.below.setdefault(above, []).append((below, label))
        settings = self.file.one("GlobalSettings").properties()
        self.metres_per_unit = 0.01 * settings["UnitScaleFactor"][0]

    def animation(self, _):
        stack = next(record for record in self.objects.values() if record.name == "AnimationStack")
        return {"name": stack.values[1].split("\0")[0]}

    def span_s(self, _=None):
        times = numpy.concatenate([record.one("KeyTime").values[0] for record in self.objects.values()
                                   if record.name == "AnimationCurve"])
        return times.min() / TICKS_PER_S, times.max() / TICKS_PER_S

    def sampled(self, model, name, value, time_s):
        """Three numbers of a model: those of its curves where it has some."""
        value = numpy.array(value, dtype=float)
        if time_s is None:
            return value
        for node, label in self.below.get(model, []):
            if label != name or self.objects[node].name != "AnimationCurveNode":
                continue
            for curve, axis in self.below.get(node, []):
                record = self.objects[curve]
                assert all(flags & LINEAR for flags in record.one("KeyAttrFlags").values[0]), "expected linear curves"
                times = record.one("KeyTime").values[0] / TICKS_PER_S
                value["XYZ".index(axis[-1])] = numpy.interp(time_s, times, record.one("KeyValueFloat").values[0])
        return value

    def world(self, model, time_s):
        properties = self.objects[model].properties()
        unsupported = [name for name in properties if "Pivot" in name or "Offset" in name or name == "PostRotation"]
        assert not unsupported, unsupported
        matrix = numpy.eye(4)
        turn = euler_matrix(self.sampled(model, "Lcl Rotation", properties.get("Lcl Rotation", [0, 0, 0]), time_s))
        scale = self.sampled(model, "Lcl Scaling", properties.get("Lcl Scaling", [1, 1, 1]), time_s)
        matrix[:3, :3] = euler_matrix(properties.get("PreRotation", [0, 0, 0])) @ turn * scale
        matrix[:3, 3] = self.sampled(model, "Lcl Translation", properties.get("Lcl Translation", [0, 0, 0]), time_s)
        for above, label in self.above.get(model, []):
            if label == "" and above in self.objects and self.objects[above].name == "Model":
                return self.world(above, time_s) @ matrix
        return matrix

    def geometry_points(self, geometry, time_s):
        points = self.objects[geometry].one("Vertices").values[0].reshape(-1, 3)
        points = numpy.hstack([points, numpy.ones((len(points), 1))])
        total, sums = numpy.zeros((len(points), 3)), numpy.zeros(len(points))
        for skin, _ in self.below.get(geometry, []):
            for cluster, _ in self.below.get(skin, []):
                record = self.objects[cluster]
                if not record.all("Indexes"):
                    continue
                link = next(below for below, _ in self.below[cluster] if self.objects[below].name == "Model")
                matrix = self.world(link, time_s) @ record.one("Transform").values[0].reshape(4, 4).T
                moved, weights = record.one("Indexes").values[0], record.one("Weights").values[0]
                total[moved] += weights[:, None] * (points[moved] @ matrix.T)[:, :3]
                sums[moved] += weights
        assert (sums > 0).all(), "expected a weight for every point"
        return total / sums[:, None]

    def points(self, _, time_s):
        geometries = [key for key, record in self.objects.items() if record.name == "Geometry"
                      and record.all("Vertices")]
        return numpy.concatenate([self.geometry_points(geometry, time_s) for geometry in geometries])
