"""Rigged models, and options of `pbskin try`, that are refused. The models are made from a valid rig of rig_files.py."""
import json
import struct

import bad_tets
import rig_files
from bad_case import Case
from bad_characters import bvh
from bad_files import secret
from bad_places import locked

WHOLE = rig_files.rig()
NO_RIG, NO_GLTF = "no rig: expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA (.dae, .zae)", "no glTF that tinygltf can read: "
NO_TRIANGLES, NOT_FINITE = "meshes = 0: expected a mesh with triangles", "expected finite numbers"
UNSUPPORTED = ": not supported: export the model without it"
ATTRIBUTES = "meshes/0/primitives/0/attributes/"


def parts(glb):
    """The document and the binary data."""
    length, = struct.unpack("<I", glb[12:16])
    return json.loads(glb[20:20 + length]), bytearray(glb[28 + length:])


def joined(document, data):
    text = json.dumps(document).encode()
    text, data = text + b" " * (-len(text) % 4), bytes(data) + bytes(-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def changed(change):
    document, data = parts(WHOLE)
    change(document, data)
    return joined(document, data)


def put(accessor_of, at, numbers):
    """Replaces bytes of an accessor, from byte `at` on."""
    def change(document, data):
        view = document["bufferViews"][document["accessors"][accessor_of(document)]["bufferView"]]
        data[view["byteOffset"] + at:view["byteOffset"] + at + len(numbers)] = numbers
    return changed(change)


def attribute(name):
    return lambda document: document["meshes"][0]["primitives"][0]["attributes"][name]


def indices(document):
    return document["meshes"][0]["primitives"][0]["indices"]


def inverse_binds(document):
    return document["skins"][0]["inverseBindMatrices"]


def times(document):
    return document["animations"][0]["samplers"][0]["input"]


def rotations(document):
    return document["animations"][0]["samplers"][0]["output"]


def lines(document, _):
    document["meshes"][0]["primitives"][0]["mode"] = 1


def without_joints(document, _):
    document["skins"][0]["joints"] = []


def joint_that_is_no_node(document, _):
    document["skins"][0]["joints"][1] = 55


def own_ancestor(document, _):
    document["nodes"][2]["children"] = [0]


def draco_alone(document, _):
    """The accessors of a compressed mesh have no data of their own."""
    document.update(extensionsRequired=["KHR_draco_mesh_compression"], extensionsUsed=["KHR_draco_mesh_compression"])
    for accessor in document["accessors"][:4]:
        accessor.pop("bufferView")


def animated_matrix(document, _):
    node = document["nodes"][document["animations"][0]["channels"][0]["target"]["node"]]
    x, y, z = node.pop("translation")
    node["matrix"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1]


def requires(extension):
    return changed(lambda document, _: document.update(extensionsRequired=[extension], extensionsUsed=[extension]))


NAN = struct.pack("<f", float("nan"))


def glbs():
    yield "truncated", WHOLE[:len(WHOLE) // 2], NO_GLTF + "Invalid glTF binary"
    yield "without_its_end", WHOLE[:-20], NO_GLTF + "Invalid glTF binary"
    yield "empty", b"", "the file is empty"
    yield "wrong_magic", b"GLTF" + WHOLE[4:], NO_RIG
    yield "text", b"hello\n", NO_RIG
    yield "nan_position", put(attribute("POSITION"), 40, NAN), ATTRIBUTES + "POSITION = 1: " + NOT_FINITE
    yield "nan_weight", put(attribute("WEIGHTS_0"), 0, NAN), ATTRIBUTES + "WEIGHTS_0 = 2: " + NOT_FINITE
    yield "negative_weight", put(attribute("WEIGHTS_0"), 0, struct.pack("<f", -3.0)), "weight of point 0 = -3: expected a finite number"
    yield "joint_out_of_range", put(attribute("JOINTS_0"), 20, b"\x4d"), "JOINTS_0 = 77: expected the number of a joint from 0 to 2"
    yield "index_out_of_range", put(indices, 8, struct.pack("<I", 99999)), "indices = 99999: expected an index from 0 to 401"
    yield "no_triangles", changed(lines), NO_TRIANGLES
    yield "skin_without_joints", changed(without_joints), "skins/0/joints: expected at least one joint"
    yield "joint_that_is_no_node", changed(joint_that_is_no_node), "skins/0/joints = 55: expected a node of the file"
    yield "nan_inverse_bind", put(inverse_binds, 0, NAN), "skins/0/inverseBindMatrices = 0: " + NOT_FINITE
    yield "zero_inverse_bind", put(inverse_binds, 0, bytes(64)), "inverseBindMatrices = 0: expected matrices that can be inverted"
    yield "nan_time", put(times, 0, NAN), "animations/0/samplers/0/input = 5: " + NOT_FINITE
    yield "time_that_goes_back", put(times, 0, struct.pack("<ff", 0.9, 0.1)), "samplers/0/input: expected times that do not go back"
    yield "node_that_is_its_own_ancestor", changed(own_ancestor), "nodes/0: is its own ancestor"
    yield "draco", requires("KHR_draco_mesh_compression"), "extensionsRequired = KHR_draco_mesh_compression" + UNSUPPORTED
    yield "draco_alone", changed(draco_alone), "extensionsRequired = KHR_draco_mesh_compression" + UNSUPPORTED
    yield "weights_all_zero", put(attribute("WEIGHTS_0"), 0, bytes(16 * 402)), "weights = 0: expected a point with a weight"
    yield "animated_matrix", changed(animated_matrix), "channels/0/target/node = 1: expected a node without a matrix"
    yield "quaternion_of_zero", put(rotations, 0, bytes(16)), "samplers/0/output, key 0: expected a quaternion that is not zero"
    yield "unknown_extension", requires("ACME_gloves"), "extensionsRequired = ACME_gloves" + UNSUPPORTED


def missing_buffer():
    document, _ = parts(WHOLE)
    document["buffers"][0]["uri"] = "gone.bin"
    return json.dumps(document)


def options():
    """(name, further words of the command line, what is said)."""
    yield "unknown_animation", ["--animation", "Walk"], "hero.glb: animation = Walk: expected one of Bend"
    yield "a_clip_that_is_none", ["--animation", "arm.toml"], "arm.toml: no clip that assimp can read"
    yield "one_frame", ["--frames", "1"], "--frames: Value 1 not in range 2 to 100000"
    yield "a_fraction_of_frames", ["--frames", "2.5"], "--frames: Value 2.5 not in range"
    yield "few_vertices", ["--vertices", "10"], "--vertices: Value 10 not in range 150 to"
    for scale in ("0", "nan", "-1", "inf", "1e-300", "1e300"):
        yield f"scale_{scale}", ["--scale", scale], f"--scale = {scale.replace('1e300', '1e+300')}: expected a number from 1e-6 to 1e6"
    yield "a_skeleton_that_is_not_there", ["--skeleton", "none.toml"], "none.toml: no such file"
    yield "another_skeleton", ["--skeleton", "human"], "hero.glb: joints of the skins = 3: expected no other skeleton"
    yield "output_under_a_file", ["-o", "hero.glb/out"], "hero.glb/out: the output folder cannot be made: Not a directory"


def tobj(tets, points=bad_tets.POINTS):
    """A tet mesh of HOBAK."""
    return "".join(f"{letter} {' '.join(map(str, row))}\n" for letter, rows in (("v", points), ("t", tets)) for row in rows)


def tets():
    """Tet meshes in the formats of other codes."""
    sound = bad_tets.TETS
    line = len(bad_tets.POINTS) + len(sound) + 1
    yield "index_out_of_range.tobj", tobj([*sound, (0, 1, 2, 4000)]), f":{line}: t = 4000: expected an index from 0 to"
    yield "negative_index.tobj", tobj([*sound, (0, 1, 2, -1)]), "t = -1: expected the number of a vertex, from 0"
    yield "three_corners.tobj", tobj([*sound, (0, 1, 2)]), "t = t 0 1 2: expected 4 numbers"
    yield "a_word.tobj", tobj(sound).replace("v ", "v east ", 1), ":1: v = east: expected a number"
    yield "nan.tobj", tobj(sound, [("nan", 0, 0), *bad_tets.POINTS[1:]]), "expected finite coordinates"
    yield "without_tets.tobj", tobj([]), "expected at least one tetrahedron"
    yield "neither_legacy_nor_xml.vtk", "solid nothing\n" * 9, "VTK: Error parsing XML in stream at line 1"


def cases():
    run = ["try", "--no-reference", "--frames", "2", "--vertices", "300"]
    for name, content, words in glbs():
        yield Case(f"model {name}", {"bad.glb": content}, [*run, "bad.glb", "-o", "out"], ("bad.glb: ", words))
    yield Case("model missing_buffer", {"bad.gltf": missing_buffer()}, [*run, "bad.gltf", "-o", "out"],
               ("bad.gltf: ", NO_GLTF + "File not found : gone.bin"))
    yield Case("trial a_clip_of_another_skeleton", {"hero.glb": WHOLE, "other.bvh": bvh(root="a", child="b")},
               [*run, "hero.glb", "-o", "out", "--animation", "other.bvh"], ("other.bvh: ", "no joint has the name of a bone"))
    yield Case("model that is missing", {}, [*run, "none.glb", "-o", "out"], ("none.glb: ", "no such file"))
    yield Case("model that is a folder", {}, [*run, ".", "-o", "out"], (".: ", "expected a file"))
    for name, words, said in options():
        output = [] if "-o" in words else ["-o", "out"]
        yield Case(f"trial {name}", {"hero.glb": WHOLE}, ["try", "hero.glb", "--no-reference", *words, *output], (said,))
    for file, content, words in tets():
        yield Case(f"tets {file}", {file: content}, ["measure", file, file], (file, words))
    yield Case("trial into a read-only folder", {"hero.glb": WHOLE, "locked": locked}, [*run, "hero.glb", "-o", "locked"],
               ("locked/scene.toml: ", "cannot be written: Permission denied"), as_nobody=True)
    yield Case("trial below a read-only folder", {"hero.glb": WHOLE, "locked": locked}, [*run, "hero.glb", "-o", "locked/out"],
               ("locked/out: ", "cannot be made: Permission denied"), as_nobody=True)
    yield Case("trial of a model that must not be read", {"hero.glb": secret}, [*run, "hero.glb", "-o", "out"],
               ("hero.glb: ", "cannot be read"), as_nobody=True)
