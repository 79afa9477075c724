"""Skeletons, weights and clips that are refused, made from a valid arm."""
import foreign_arm
from bad_case import Case
from bad_tets import NOISE, POINTS, sparse

SKELETON = foreign_arm.SKELETON
SCENE = foreign_arm.SCENE.replace("arm.msh", "arm.vtu")
HEADER = "vertex,joint,weight\n"
WEIGHTS = HEADER + "".join(f"{v},shoulder,0.5\n{v},elbow,0.5\n" for v in range(len(POINTS)))
ROW = "0 0 0 0 0 0 10 20 30\n"


def joint(name, parent, head, tail):
    return f'[[joint]]\nname = "{name}"\nparent = "{parent}"\nhead_m = {head}\ntail_m = {tail}\n'


FINITE = "expected three finite numbers"
PARSING = "Error while parsing "


def skeletons():
    yield "empty", "", ": joint: expected at least one [[joint]]"
    yield "noise", NOISE, ":1: byte = 0: expected ASCII outside of texts"
    yield "truncated", SKELETON[:60], ":4: " + PARSING + "array: encountered end-of-file"
    yield "zero_length", SKELETON.replace("tail_m = [0.5", "tail_m = [0.0"), ":1: shoulder.tail_m = [0 0 0]: a bone needs a length"
    yield "no_root", SKELETON.replace('parent = ""', 'parent = "elbow"'), "no root"
    yield ("cyclic_parents", SKELETON + joint("a", "b", [0, 0, 0], [1, 0, 0]) + joint("b", "a", [0, 0, 0], [1, 0, 0]),
           ":11: a.parent = b: its parents form a cycle")
    yield "own_parent", SKELETON.replace('parent = "shoulder"', 'parent = "elbow"'), ":6: elbow.parent = elbow: its parents form a cycle"
    yield ("unknown_parent", SKELETON.replace('parent = "shoulder"', 'parent = "sholder"'),
           ":6: elbow.parent = sholder: no such joint; the nearest is 'shoulder'")
    yield "name_twice", SKELETON.replace('"elbow"', '"shoulder"'), ":6: name = shoulder: already used in line 1"
    yield "nan", SKELETON.replace("[1.0,", "[nan,"), ":10: tail_m = [ nan, 0.0, 0.0 ]: " + FINITE
    yield "infinity", SKELETON.replace("[1.0,", "[inf,"), ":10: tail_m = [ inf, 0.0, 0.0 ]: " + FINITE
    yield "two_numbers", SKELETON.replace("[1.0, 0.0, 0.0]", "[1.0, 0.0]"), ":10: tail_m = [ 1.0, 0.0 ]: " + FINITE
    yield "a_word", SKELETON.replace("[1.0, 0.0, 0.0]", '"far"'), ":10: tail_m = 'far': " + FINITE
    yield "unknown_key", SKELETON.replace("tail_m", "tial_m"), ":5: tial_m: unknown key; the nearest known one is tail_m"
    yield "outside_the_mesh", SKELETON.replace("[0.", "[50.").replace("[1.", "[51."), "no bone reaches the mesh's bounding box"
    yield "in_millimetres", SKELETON.replace("0.5,", "500.0,").replace("[1.0,", "[1000.0,"), "mesh and skeleton in different units"
    yield "beyond_range", SKELETON.replace("[1.0,", "[1e300,"), ":6: elbow: expected a bone within 1e9 m"
    yield "nested_arrays", "a=" + "[" * 100000, ":1: " + PARSING + "value: exceeded maximum nested value depth"
    yield "nested_keys", "[" + "a." * 50000 + "a]\nx = 1\n", "nested too deep: expected at most 64 parts"
    yield "nested_keys_of_an_inline_table", "x = {" + "a." * 1_500_000 + "a = 1}\n", "nested too deep: expected at most 64 parts"
    yield "not_utf8", SKELETON.encode().replace(b"elbow", b"\xff\xfe"), ":7: Encountered invalid utf-8 sequence"
    yield "sparse", sparse, "bytes = 68719476736: expected at most 16777216"
    yield "no_joint", "x = 1\n", ":1: x: unknown key"
    yield ("thousands_of_joints", "".join(joint(f"j{i}", "", [i, 0, 0], [i + 1, 0, 0]) for i in range(2500)),
           "joints = 2500: expected at most 2000")


def weights():
    yield "empty", "", ":1: expected the header"
    yield "noise", NOISE, ":1: expected the header"
    yield "no_header", WEIGHTS[len(HEADER):], ":1: expected the header"
    yield "sparse", sparse, "bytes = 68719476736: expected at most 268435456"
    yield "truncated", WEIGHTS[:100], "has no weights"
    yield "sum_not_one", WEIGHTS.replace("3,elbow,0.5", "3,elbow,0.4", 1), ":9: vertex 3 = 0.900000: its weights must sum to one"
    yield "negative", WEIGHTS.replace("3,elbow,0.5", "3,elbow,-0.5", 1), ":9: weight = -0.5: expected 0 <= weight <= 1"
    yield "nan", WEIGHTS.replace("3,elbow,0.5", "3,elbow,nan", 1), ":9: weight = nan: expected 0 <= weight <= 1"
    yield "unknown_joint", WEIGHTS.replace("3,elbow", "3,elbo", 1), ":9: joint = elbo: no such joint; the nearest is 'elbow'"
    yield ("unknown_joint_of_ten_million_letters", WEIGHTS.replace("3,elbow", "3," + 2_000_000 * "elbow", 1),
           ":9: joint = " + 16 * "elbow" + "...: no such joint; the nearest is 'elbow'")
    yield ("control_characters", WEIGHTS.replace("3,elbow", "3,el\x1b[2Jbow\a", 1),
           ":9: joint = el\\x1b[2Jbow\\x07: no such joint; the nearest is 'elbow'")
    yield "vertex_out_of_range", WEIGHTS.replace("\n3,elbow", "\n99,elbow", 1), ":9: vertex = 99: expected a vertex from 0 to 44"
    yield "negative_vertex", WEIGHTS.replace("\n3,elbow", "\n-3,elbow", 1), ":9: vertex = -3: expected a vertex from 0 to 44"
    yield "vertex_beyond_int", WEIGHTS.replace("\n3,elbow", "\n99999999999999,elbow", 1), ":9: vertex = 99999999999999: expected a vertex"
    yield "joint_twice", WEIGHTS.replace("\n3,elbow", "\n3,shoulder", 1), ":9: joint = shoulder: vertex 3 has this joint already"
    yield "two_fields", WEIGHTS.replace("3,elbow,0.5", "3,elbow", 1), ":9: expected three fields"
    yield "a_line_of_ten_million_digits", HEADER + "1" * 10_000_000, ":2: expected three fields"


def bvh(frames="2", time="0.01", motion=2 * ROW, root="shoulder", child="elbow", offset="1 0 0"):
    return (f"HIERARCHY\nROOT {root}\n{{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
            f" JOINT {child}\n {{\n  OFFSET {offset}\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
            f"  End Site\n  {{\n   OFFSET 1 0 0\n  }}\n }}\n}}\n"
            f"MOTION\nFrames: {frames}\nFrame Time: {time}\n{motion}")


FRAME_TIME, NO_CLIP = "expected a time from 1e-6 to 1000 s", "no clip that assimp can read: "


def clips():
    yield "empty", "", NO_CLIP + "File is too small"
    yield "noise", NOISE, 'Expected header string "HIERARCHY"'
    yield "sparse", sparse, "bytes = 68719476736: expected at most 268435456"
    yield "noise_in_the_hierarchy", b"HIERARCHY\n" + NOISE, 'Expected root node "ROOT"'
    yield "truncated_hierarchy", bvh()[:120], 'Expected opening brace "{"'
    yield "truncated_motion", bvh(motion=ROW + "0 0 0"), "Unexpected end of file"
    yield "no_motion", bvh().split("MOTION")[0], 'Expected beginning of motion data "MOTION"'
    yield "no_frames", bvh("0", motion=""), ":17: Frames = 0: expected a whole number of frames"
    yield "negative_frames", bvh("-1"), ":17: Frames = -1: expected a whole number of frames"
    yield "huge_frames", bvh("4000000000"), ":17: Frames = 4000000000: the file is too short"
    yield "more_rows_than_frames", bvh(motion=50 * ROW), ":19: motion = 450 numbers: expected Frames times channels: 18"
    yield "one_frame", bvh("1", motion=ROW), "no frame is left after the first"
    yield "no_frames_behind_a_blank_line", "\n" + bvh("0", motion=""), ":18: Frames = 0: expected a whole number of frames"
    yield "frame_time_zero_behind_a_byte_order_mark", "\ufeff" + bvh(time="0"), ":18: Frame Time = 0: " + FRAME_TIME
    yield "frame_time_zero", bvh(time="0"), ":18: Frame Time = 0: " + FRAME_TIME
    yield "frame_time_nan", bvh(time="nan"), ":18: Frame Time = nan: " + FRAME_TIME
    yield "frame_time_negative", bvh(time="-0.1"), ":18: Frame Time = -0.1: " + FRAME_TIME
    yield "frame_time_beyond_range", bvh(time="1e300"), ":18: Frame Time = 1e300: " + FRAME_TIME
    yield "frame_time_below_range", bvh(time="1e-300"), ":18: Frame Time = 1e-300: " + FRAME_TIME
    yield "nan_channel", bvh(motion=ROW + ROW.replace("20", "nan")), "frame 1 = elbow: its rotation is not a finite number"
    yield "channel_beyond_range", bvh(motion=ROW + ROW.replace("20", "1e39")), "frame 1 = elbow: its rotation is not a finite number"
    yield "a_word_for_a_channel", bvh(motion=ROW + ROW.replace("20", "east")), 'Cannot parse string "east" as a real number'
    yield "names_that_do_not_match", bvh(root="a", child="b"), "no joint has the name of a bone (bones: shoulder, elbow)"
    yield "name_twice", bvh(child="shoulder"), "JOINT = shoulder: two joints have this name"
    yield "nan_offset", bvh(offset="nan 0 0"), "OFFSET: expected finite numbers"
    yield "channels_of_other_number", bvh().replace("CHANNELS 6", "CHANNELS 60"), 'Invalid channel specifier "JOINT"'
    yield "unknown_channel", bvh().replace("Xposition", "Qposition"), 'Invalid channel specifier "Qposition"'
    yield ("nested_joints", "HIERARCHY\nROOT a\n{\n OFFSET 0 0 0\n CHANNELS 3 Zrotation Yrotation Xrotation\n" + "JOINT b\n{\n" * 100000,
           "nested deeper than 500 joints")
    yield "wrong_magic", b"\x89PNG\r\n\x1a\n" + NOISE, 'Expected header string "HIERARCHY"'


def cases():
    run = ["run", "arm.toml", "-o", "out", "--set"]
    for name, content, words in skeletons():
        yield Case(f"skeleton {name}", {"bad.toml": content}, [*run, "character.skeleton=bad.toml"], ("bad.toml", words))
    for name, content, words in weights():
        yield Case(f"weights {name}", {"bad.csv": content}, [*run, "skinning.weights=bad.csv"], ("bad.csv", words))
    for name, content, words in clips():
        yield Case(f"clip {name}", {"bad.bvh": content}, ["run", "clip.toml", "-o", "out", "--set", "motion.clip=bad.bvh"],
                   ("bad.bvh", words))
    for name, setting, words in (("start_after_the_end", "motion.start_s=99", "start_s = 99.000000: the clip lasts"),
                                 ("duration_beyond_the_end", "motion.duration_s=99", "duration_s = 99.000000: the clip ends at"),
                                 ("rate_of_a_million_steps", "motion.rate_hz=0.001", "expected at most 100000 steps per frame")):
        yield Case(f"clip {name}", {}, ["run", "clip.toml", "-o", "out", "--set", setting,
                                        *(["--set", "pbs.time_step_s=1e-9"] if "million" in name else [])], (words,))
