"""Clips in glTF and FBX that are refused, also when read as skeletons."""
from bad_case import Case
from bad_surfaces import gltf as surface
from bad_tets import NOISE
from binary_bytes import IDENTITY, fbx, fbx_node, gltf_clip

NAN = float("nan")
NO_READER, NO_END = "no clip that assimp can read: No suitable reader found", "FBX-Parser unexpected end of file"
NOT_FINITE, OFFSET = "frame 1 = elbow: its rotation is not a finite number", "FBX-Tokenize (offset 0x1f) block offset is "
TIMES = "expected finite times that do not go back"
RECURSIVE, ONE_FRAME = "has recursive reference to itself", "Frames = 1: no frame is left after the first"


def gltfs():
    whole = gltf_clip()
    yield "empty", "", NO_READER
    yield "noise", NOISE, NO_READER
    yield "truncated", whole[: len(whole) // 2], NO_READER
    yield "no_animation", surface(), "holds no motion"
    yield "no_frames", gltf_clip(times=(), turns=()), "data is null when extracting data from accessors[0]"
    yield "one_frame", gltf_clip(times=(0.0,), turns=(IDENTITY,)), ONE_FRAME
    yield "nan_turn", gltf_clip(turns=(IDENTITY, (NAN, 0, 0, 1), IDENTITY)), NOT_FINITE
    yield "turn_of_no_length", gltf_clip(turns=(IDENTITY, (0, 0, 0, 0), IDENTITY)), "damaged: the reader's answer is not a whole clip"
    yield "nan_time", gltf_clip(times=(0.0, NAN, 1.0)), "key 1 = nan: " + TIMES
    yield "time_that_goes_back", gltf_clip(times=(0.0, 1.0, 0.5)), TIMES
    yield "infinite_time", gltf_clip(times=(0.0, 0.5, float("inf"))), "key 2 = inf: " + TIMES
    yield "huge_time", gltf_clip(times=(0.0, 0.5, 1e30)), "expected 1 to 10000000"
    yield "all_at_one_time", gltf_clip(times=(0.0, 0.0, 0.0)), ONE_FRAME
    yield "names_that_do_not_match", gltf_clip(names=("a", "b")), "no joint has the name of a bone (bones: shoulder, elbow)"
    yield "name_twice", gltf_clip(names=("elbow", "elbow")), "JOINT = elbow: two joints have this name"
    yield "huge_count", gltf_clip(count=4000000000), "(0/16000000000) is out of range"
    yield "buffer_beyond_its_data", gltf_clip(bytes_told=4000), "expected 4000 bytes, but found 80"
    yield "node_out_of_range", gltf_clip(target=9), 'Array index 9 is out of bounds (2) for "nodes"'
    yield "offset_beyond_range", gltf_clip(offset=(1e39, 0, 0)), "OFFSET: expected finite numbers"
    yield "cyclic_nodes", whole.replace('"name": "elbow"', '"name": "elbow", "children": [0]'), RECURSIVE
    yield "own_child", whole.replace('"children": [1]', '"children": [0]'), RECURSIVE
    yield "child_out_of_range", whole.replace('"children": [1]', '"children": [7]'), 'Array index 7 is out of bounds (2) for "nodes"'


def fbxs():
    text = "; FBX 7.3.0 project file\n"
    yield "empty", "", NO_END
    yield "noise", NOISE, NO_END
    yield "magic_alone", fbx(), "cannot ReadWord, out of bounds"
    yield "magic_and_noise", fbx(NOISE), OFFSET + "out of range"
    yield "no_nodes", fbx(bytes(13)), NO_END
    yield "huge_end_of_a_node", fbx(fbx_node(b"Objects", 4000000000)), OFFSET + "out of range"
    yield "end_before_the_beginning", fbx(fbx_node(b"Objects", 3)), OFFSET + "negative out of range"
    yield "huge_property_count", fbx(fbx_node(b"Objects", 60, 4000000000, 4000000000) + bytes(60)), "property length out of bounds"
    yield "truncated_text", text + "Objects: {\n", NO_END
    yield ("no_motion", text + "FBXHeaderExtension: {\n FBXHeaderVersion: 1003\n FBXVersion: 7300\n}\nObjects: {\n}\nConnections: {\n}\n",
           "holds no motion")
    yield "nested_nodes", text + "a: {\n" * 100000, "damaged: the reader broke down on it"


def skeletons():
    yield "noise.gltf", NOISE, NO_READER
    yield "empty.fbx", "", NO_END
    yield "joints_at_one_place.gltf", gltf_clip(offset=(0, 0, 0)), "joints = 2: expected joints apart from each other"


def cases():
    for extension, defects in ((".gltf", gltfs), (".fbx", fbxs)):
        file = "bad" + extension
        for name, content, words in defects():
            yield Case(f"clip {name}{extension}", {file: content}, ["run", "clip.toml", "-o", "out", "--set", "motion.clip=" + file],
                       (file + ": ", words))
    for name, content, words in skeletons():
        file = "bad." + name.split(".")[1]
        yield Case(f"skeleton {name}", {file: content}, ["run", "arm.toml", "-o", "out", "--set", "character.skeleton=" + file],
                   (file + ": ", words))
    yield Case("clip of an unknown kind", {"bad.mp3": "ID3"}, ["run", "clip.toml", "-o", "out", "--set", "motion.clip=bad.mp3"],
               ("bad.mp3: ", NO_READER))
