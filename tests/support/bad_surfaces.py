"""Surfaces that `pbskin mesh` refuses, in every format."""
import base64
import io
import json
import os
import struct
import zipfile

from bad_case import Case
from bad_tets import NOISE, sparse

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


# the words for a defect by format, in the order of soups(); CGAL reads OFF, PLY and STL up to the defect
NO_FURTHER = "damaged: CGAL read {} points and {} faces, and no further"
NO_TRIANGLES, INDEX = "triangles = 0: expected at least one triangle", "assimp: OBJ: vertex index out of range"
NOISY = {".obj": NO_TRIANGLES, ".off": NO_FURTHER.format(0, 0), ".ply": NO_FURTHER.format(0, 0), ".stl": ", and no further"}
CUT = {".obj": NO_TRIANGLES, ".off": NO_FURTHER.format(4, 4), ".ply": NO_FURTHER.format(0, 0), ".stl": NO_FURTHER.format(11, 4)}
NOT_FINITE = {".obj": "vertex 0: expected finite coordinates", ".off": NO_FURTHER.format(4, 4), ".ply": NO_FURTHER.format(0, 0),
              ".stl": NO_FURTHER.format(12, 5)}
BEYOND = {".obj": INDEX, ".off": NO_FURTHER.format(4, 4), ".ply": "face 3 vertex = 9: expected an index from 0 to 3"}
BELOW = BEYOND | {".ply": "face 3 vertex = -9: expected an index from 0 to 3"}


def soups():
    nan, vast = [("nan", 0, 0), *POINTS[1:]], [[1e300 * x for x in point] for point in POINTS]
    for extension, write in ((".obj", obj), (".off", off), (".ply", ply), (".stl", stl)):
        whole = write()
        yield "empty" + extension, "", "the file is empty"
        yield "noise" + extension, NOISE, NOISY[extension]
        yield "truncated" + extension, whole[: len(whole) * 3 // 5], CUT[extension]
        yield "nan" + extension, write(nan), NOT_FINITE[extension]
        yield "open" + extension, write(POINTS, FACES[:3]), "expected a closed surface"
        yield "no_faces" + extension, write(POINTS, []), NO_TRIANGLES
        yield "beyond_range" + extension, write(vast), "expected finite coordinates within 1e9 m"
        if extension in BEYOND:
            yield "index_out_of_range" + extension, write(POINTS, OUT), BEYOND[extension]
            yield "negative_index" + extension, write(POINTS, NEGATIVE), BELOW[extension]
    for extension in (".obj", ".off", ".gltf"):
        yield "sparse" + extension, sparse, "bytes = 68719476736: expected at most 1073741824"
    yield "no_points.ply", ply([]), "points = 0: expected at least one point"
    yield "one_point.ply", ply(POINTS[:1]), "face 0 vertex = 2: expected 0"
    yield "huge_count.off", off(count=4000000000), NO_FURTHER.format(0, 0)
    yield "huge_count.ply", ply(count=4000000000), NO_FURTHER.format(9, 0)
    yield "huge_count.stl", b"\0" * 80 + struct.pack("<I", 4000000000) + b"\0" * 50, NO_FURTHER.format(1, 1)


MALFORMED, NO_READER, MEMORY = "assimp: Unable to read file, malformed XML", "assimp: No suitable reader found", "asks for more memory"


def scenes():
    yield "empty.dae", "", "the file is empty"
    yield "noise.dae", NOISE, MALFORMED
    yield "truncated.dae", dae()[:700], MALFORMED
    yield "nan.dae", dae(points="nan 0 0 1 0 0 0 1 0 0 0 1"), "vertex 0: expected finite coordinates"
    yield "index_out_of_range.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 99"), "Invalid data index (99/4)"
    yield "negative_index.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 -5"), "p = -5: expected indices from 0"
    yield "a_word_for_an_index.dae", dae(faces="0 2 1 0 1 3 0 3 2 1 2 x"), MEMORY
    yield "huge_count.dae", dae(count=3000000000), MEMORY
    yield "too_few_indices.dae", dae(faces="0 2 1"), "Expected different index count"
    yield "noise.zae", NOISE, MALFORMED
    yield "truncated.zae", zae(dae())[:200], MALFORMED
    yield "without_a_dae.zae", zae("text", "a.txt"), "Invalid ZAE"
    yield "noise.gltf", NOISE, NO_READER
    yield "empty_object.gltf", "{}", NO_READER
    yield "truncated.gltf", gltf()[:300], NO_READER
    yield "huge_count.gltf", gltf(points=4000000000), "(0/16000000000) is out of range"
    yield "huge_index_count.gltf", gltf(indices=4000000000), "(0/8000000000) is out of range"
    yield "view_beyond_its_buffer.gltf", gltf(bytes_of_indices=4000000), "(48/4000000) is out of range"
    yield "buffer_that_is_not_there.gltf", gltf(uri="none.bin"), 'could not open referenced file "none.bin"'
    for name, uri in (("without_end", "/dev/zero"), ("elsewhere", "/etc/passwd")):
        yield f"buffer_{name}.gltf", gltf(uri=uri), f"referred file = {uri}: expected a regular file below the folder"
    yield "unknown_component.gltf", gltf(component=1), "Unsupported Component Type 1"
    yield "wrong_magic.glb", NOISE, NO_READER
    yield "huge_chunk.glb", b"glTF" + struct.pack("<III", 2, 4000000000, 4000000000) + b"JSON{}", NO_READER


def waited_for():
    yield Case("surface whose buffer is a pipe", {"bad.gltf": gltf(uri="pipe"), "pipe": os.mkfifo}, ["mesh", "bad.gltf", "-o", "tets.vtu"],
               ("bad.gltf: referred file = pipe: expected a regular file below the folder",))


def places():
    """These are refused before the long computation for so many vertices."""
    for name, output, words, others in (("a folder that is not there", "none/tets.vtu", "cannot be written: No such file or directory", {}),
                                        ("a folder's place", "tets.vtu", "cannot be written: Is a directory", {"tets.vtu": os.mkdir}),
                                        ("a folder under a file", "file/tets.vtu", "cannot be written: Not a directory", {"file": "text"}),
                                        ("a read-only folder", "locked/tets.vtu", "cannot be written: Permission denied",
                                         {"locked": lambda path: path.mkdir(mode=0o555)}),
                                        ("an unknown kind", "tets.step", "extension = .step: expected .msh, .vtu or .mesh", {})):
        yield Case(f"surface into {name}", {"good.off": off(), **others}, ["mesh", "good.off", "-o", output, "--vertices", "1000000"],
                   (f"{output}: {words}",), as_nobody=name == "a read-only folder")


def cases():
    yield from places()
    yield from waited_for()
    for name, content, words in [*soups(), *scenes()]:
        file = "bad." + name.split(".")[1]
        yield Case(f"surface {name}", {file: content}, ["mesh", file, "-o", "tets.vtu", "--vertices", "200"], (file + ":", words))
    yield Case("surface of an unknown kind", {"bad.step": "ISO-10303-21;"}, ["mesh", "bad.step", "-o", "tets.vtu"],
               ("bad.step: extension = .step: expected a surface",))
    yield Case("surface into too few vertices", {"good.off": off()}, ["mesh", "good.off", "-o", "tets.vtu", "--vertices", "3"],
               ("--vertices: Value 3 not in range",))
