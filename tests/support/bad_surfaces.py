"""Surfaces that `pbskin mesh` refuses, in every format."""
import base64
import io
import json
import struct
import zipfile

from bad_case import Case
from bad_tets import NOISE

POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
OUT, NEGATIVE = [*FACES[:3], (0, 1, 9)], [*FACES[:3], (0, 1, -9)]


def rows(table, before=""):
    return "".join(before + " ".join(map(str, row)) + "\n" for row in table)


def obj(points=POINTS, faces=FACES):
    return rows(points, "v ") + rows([[vertex + 1 for vertex in face] for face in faces], "f ")


def off(points=POINTS, faces=FACES, count=None):
    return f"OFF\n{count or len(points)} {len(faces)} 0\n{rows(points)}{rows(faces, '3 ')}"


def ply(points=POINTS, faces=FACES, count=None):
    return (f"ply\nformat ascii 1.0\nelement vertex {count or len(points)}\nproperty double x\nproperty double y\nproperty double z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n{rows(points)}{rows(faces, '3 ')}")


def stl(points=POINTS, faces=FACES):
    facet = lambda face: f"facet normal 0 0 0\nouter loop\n{rows([points[vertex] for vertex in face], 'vertex ')}endloop\nendfacet\n"
    return f"solid a\n{''.join(map(facet, faces))}endsolid a\n"


def dae(points="0 0 0 1 0 0 0 1 0 0 0 1", faces="0 2 1 0 1 3 0 3 2 1 2 3", count=12):
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">'
            '<asset><unit meter="1"/></asset>'
            '<library_geometries><geometry id="g" name="g"><mesh><source id="p">'
            f'<float_array id="pa" count="{count}">{points}</float_array><technique_common>'
            f'<accessor source="#pa" count="{count // 3}" stride="3">{axes}</accessor></technique_common></source>'
            '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
            '<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>'
            f'<p>{faces}</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node id="n">'
            '<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>'
            '<scene><instance_visual_scene url="#s"/></scene></COLLADA>')


def zae(content, name="a.dae"):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, content)
    return packed.getvalue()


def gltf(points=4, indices=12, uri=None, bytes_of_indices=24, component=5123):
    data = struct.pack("<12f", *sum(POINTS, ())) + struct.pack("<12H", *sum(FACES, ()))
    views = [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": bytes_of_indices}]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": points, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
                 {"bufferView": 1, "componentType": component, "count": indices, "type": "SCALAR"}]
    uri = uri or "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "accessors": accessors,
                       "bufferViews": views,
                       "buffers": [{"byteLength": len(data), "uri": uri}]})


def soups():
    nan, vast = [("nan", 0, 0), *POINTS[1:]], [[1e300 * x for x in point] for point in POINTS]
    for extension, write in ((".obj", obj), (".off", off), (".ply", ply), (".stl", stl)):
        whole = write()
        yield "empty" + extension, "", "the file is empty"
        yield "noise" + extension, NOISE, ""
        yield "truncated" + extension, whole[: len(whole) * 3 // 5], ""
        yield "nan" + extension, write(nan), ""
        yield "open" + extension, write(POINTS, FACES[:3]), "expected a closed surface"
        yield "no_faces" + extension, write(POINTS, []), "triangles = 0: expected at least one triangle"
        yield "beyond_range" + extension, write(vast), "expected finite coordinates within 1e9 m"
        if extension != ".stl":
            yield "index_out_of_range" + extension, write(POINTS, OUT), ""
            yield "negative_index" + extension, write(POINTS, NEGATIVE), ""
    yield "huge_count.off", off(count=4000000000), "damaged: "
    yield "huge_count.ply", ply(count=4000000000), "damaged: "
    yield "huge_count.stl", b"\0" * 80 + struct.pack("<I", 4000000000) + b"\0" * 50, "damaged: "


def scenes():
    yield "empty.dae", "", "the file is empty"
    yield "noise.dae", NOISE, "assimp: "
    yield "truncated.dae", dae()[:700], "malformed XML"
    yield "nan.dae", dae(points="nan 0 0 1 0 0 0 1 0 0 0 1"), "vertex 0: expected finite coordinates"
    yield "index_out_of_range.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 99"), "Invalid data index (99/4)"
    yield "negative_index.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 -5"), "p = -5: expected indices from 0"
    yield "a_word_for_an_index.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 x"), "assimp: "
    yield "huge_count.dae", dae(count=3000000000), "assimp: "
    yield "too_few_indices.dae", dae(faces="0 2 1"), "Expected different index count"
    yield "noise.zae", NOISE, "assimp: "
    yield "truncated.zae", zae(dae())[:200], "assimp: "
    yield "without_a_dae.zae", zae("text", "a.txt"), "Invalid ZAE"
    yield "noise.gltf", NOISE, "assimp: "
    yield "empty_object.gltf", "{}", "assimp: "
    yield "truncated.gltf", gltf()[:300], "assimp: "
    yield "huge_count.gltf", gltf(points=4000000000), "out of range"
    yield "huge_index_count.gltf", gltf(indices=4000000000), "out of range"
    yield "view_beyond_its_buffer.gltf", gltf(bytes_of_indices=4000000), "out of range"
    yield "buffer_that_is_not_there.gltf", gltf(uri="none.bin"), "none.bin"
    yield "buffer_without_end.gltf", gltf(uri="/dev/zero"), "assimp: "
    yield "unknown_component.gltf", gltf(component=1), "Unsupported Component Type 1"
    yield "wrong_magic.glb", NOISE, "assimp: "
    yield "huge_chunk.glb", b"glTF" + struct.pack("<III", 2, 4000000000, 4000000000) + b"JSON{}", "assimp: "


def cases():
    for name, content, words in [*soups(), *scenes()]:
        file = "bad." + name.split(".")[1]
        yield Case(f"surface {name}", {file: content}, ["mesh", file, "-o", "tets.vtu", "--vertices", "200"], (file + ":", words))
    yield Case("surface of an unknown kind", {"bad.step": "ISO-10303-21;"}, ["mesh", "bad.step", "-o", "tets.vtu"],
               ("bad.step: extension = .step",))
    yield Case("surface into an unknown kind", {"good.off": off()}, ["mesh", "good.off", "-o", "tets.vtu", "--vertices", "3"],
               ("--vertices",))
