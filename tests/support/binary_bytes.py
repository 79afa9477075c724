"""Writes meshes and clips as binary files, number by number, so that any of the numbers can be wrong: MSH 2.2 and 4.1, PLY, STL, GLB, and
glTF clips. Indices count from 0; `*_told` are the counts that the file states."""
import base64
import json
import struct

IDENTITY, QUARTER_TURN = (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.70710678, 0.70710678)


def msh22(points, tets, vertices_told=None, tets_told=None, one=1):
    nodes = b"".join(struct.pack("<i3d", number, *point) for number, point in enumerate(points, 1))
    elements = b"".join(struct.pack("<7i", number, 1, 1, *(vertex + 1 for vertex in tet)) for number, tet in enumerate(tets, 1))
    header = struct.pack("<3i", 4, len(tets) if tets_told is None else tets_told, 2)
    return (b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", one) + b"\n$EndMeshFormat\n"
            b"$Nodes\n%d\n" % (vertices_told or len(points)) + nodes + b"\n$EndNodes\n"
            b"$Elements\n%d\n" % (tets_told or len(tets)) + header + elements + b"\n$EndElements\n")


def msh41(points, tets, vertices_told=None, tets_told=None, last_tag=None):
    """ASCII; `last_tag` replaces the tag of the last vertex, also where tets use it."""
    count, cells = vertices_told or len(points), tets_told or len(tets)
    tags = [*range(1, len(points)), len(points) if last_tag is None else last_tag]
    rows = lambda table: "".join(" ".join(map(str, row)) + "\n" for row in table)
    corner = lambda vertex: tags[vertex] if isinstance(vertex, int) and 0 <= vertex < len(tags) else vertex + 1
    return (f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {count} 1 {max(tags)}\n3 1 0 {count}\n{rows([[tag] for tag in tags])}"
            f"{rows(points)}$EndNodes\n$Elements\n1 {cells} 1 {cells}\n3 1 4 {cells}\n"
            f"{rows([(number, *map(corner, tet)) for number, tet in enumerate(tets, 1)])}$EndElements\n")


def msh41_binary(points, tets, vertices_told=None, tets_told=None):
    count, cells = vertices_told or len(points), tets_told or len(tets)
    tags = struct.pack(f"<{len(points)}Q", *range(1, len(points) + 1))
    nodes = struct.pack("<4Q3iQ", 1, count, 1, count, 3, 1, 0, count) + tags + b"".join(struct.pack("<3d", *point) for point in points)
    elements = b"".join(struct.pack("<5Q", number, *(vertex + 1 for vertex in tet)) for number, tet in enumerate(tets, 1))
    return (b"$MeshFormat\n4.1 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n" + nodes + b"\n$EndNodes\n"
            b"$Elements\n" + struct.pack("<4Q3iQ", 1, cells, 1, cells, 3, 1, 4, cells) + elements + b"\n$EndElements\n")


def ply(points, faces, vertices_told=None, faces_told=None, corners=3):
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {vertices_told or len(points)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {faces_told or len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    return (header.encode() + b"".join(struct.pack("<3f", *point) for point in points)
            + b"".join(struct.pack("<B3i", corners, *face) for face in faces))


def stl(points, faces, faces_told=None):
    facet = lambda face: struct.pack("<12fH", 0, 0, 0, *(x for vertex in face for x in points[vertex]), 0)
    return b"\0" * 80 + struct.pack("<I", len(faces) if faces_told is None else faces_told) + b"".join(map(facet, faces))


def surface_arrays(points, faces):
    return struct.pack(f"<{3 * len(points)}f", *(x for point in points for x in point)), \
        struct.pack(f"<{3 * len(faces)}H", *(vertex for face in faces for vertex in face))


def accessor(view, component, count, kind, **more):
    return {"bufferView": view, "componentType": component, "count": count, "type": kind, **more}


def views(*parts):
    """Buffer views of consecutive parts of a buffer."""
    begin, found = 0, []
    for part in parts:
        found.append({"buffer": 0, "byteOffset": begin, "byteLength": len(part)})
        begin += len(part)
    return found


def surface_document(points, faces, corners_told=None, **buffer):
    arrays = surface_arrays(points, faces)
    corners = 3 * len(faces) if corners_told is None else corners_told
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [accessor(0, 5126, len(points), "VEC3"), accessor(1, 5123, corners, "SCALAR")],
            "bufferViews": views(*arrays), "buffers": [{"byteLength": sum(map(len, arrays)), **buffer}]}


def gltf(points, faces, corners_told=None):
    uri = "data:application/octet-stream;base64," + base64.b64encode(b"".join(surface_arrays(points, faces))).decode()
    return json.dumps(surface_document(points, faces, corners_told, uri=uri))


def glb(points, faces, version=2, json_length=None, length=None, corners_told=None):
    arrays, document = surface_arrays(points, faces), surface_document(points, faces, corners_told)
    text, data = json.dumps(document).encode(), b"".join(arrays)
    text, data = text + b" " * (-len(text) % 4), data + b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I", len(text) if json_length is None else json_length) + b"JSON" + text \
        + struct.pack("<I", len(data)) + b"BIN\0" + data
    return b"glTF" + struct.pack("<II", version, 12 + len(chunks) if length is None else length) + chunks


def gltf_clip(times=(0.0, 0.5, 1.0), turns=(IDENTITY, QUARTER_TURN, IDENTITY), names=("shoulder", "elbow"), count=None, target=1,
              offset=(1.0, 0.0, 0.0), bytes_told=None):
    """A shoulder and an elbow with the given rotations."""
    parts = struct.pack(f"<{len(times)}f", *times), struct.pack(f"<{4 * len(turns)}f", *(x for turn in turns for x in turn))
    uri = "data:application/octet-stream;base64," + base64.b64encode(b"".join(parts)).decode()
    told = len(times) if count is None else count
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": names[0], "children": [1]}, {"name": names[1], "translation": offset}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": target, "path": "rotation"}}],
                        "samplers": [{"input": 0, "output": 1}]}],
        "accessors": [accessor(0, 5126, told, "SCALAR", min=[0.0], max=[1.0]), accessor(1, 5126, told, "VEC4")],
        "bufferViews": views(*parts), "buffers": [{"byteLength": bytes_told or sum(map(len, parts)), "uri": uri}]})


def fbx(nodes=b"", version=7400):
    """Binary FBX: its magic, and the nodes."""
    return b"Kaydara FBX Binary  \x00\x1a\x00" + struct.pack("<I", version) + nodes


def fbx_node(name, end, properties=0, bytes_of_properties=0):
    return struct.pack("<3IB", end, properties, bytes_of_properties, len(name)) + name
