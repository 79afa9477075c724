"""Scenes and settings that are refused, as texts of bad.toml and of --set."""
from bad_characters import SCENE, bvh
from bad_case import Case
from bad_tets import NOISE, sparse

CLIP_SCENE = SCENE.replace('joint = "elbow"\naxis = [0.0, 0.0, 1.0]\nangle_deg = 120.0\nframes = 5\n', 'clip = "good.bvh"\n')
CLIP = bvh("3", motion=3 * "0 0 0 0 0 0 10 20 30\n")
UNIT, PARSING, DEEP = "expected a number from 0 to 1", "Error while parsing ", "nested too deep: expected at most 64 parts"
WHOLE = "expected an integer from "
FEM_SCENE = SCENE + '[[fem]]\nname = "p1"\nmodel = "linear"\n'


def scenes():
    yield "empty", "", "schema: missing"
    yield "noise", NOISE, ":1: byte = 0: expected ASCII outside of texts"
    yield "sparse", sparse, "bytes = 68719476736: expected at most 16777216"
    yield "truncated", SCENE[:50], ":4: " + PARSING + "key-value pair: encountered end-of-file"
    yield "no_schema", SCENE.replace("schema = 1\n", ""), "schema: missing"
    yield "schema_of_tomorrow", SCENE.replace("schema = 1", "schema = 2"), ":1: schema = 2: " + WHOLE + "1 to 1"
    yield "unknown_key", SCENE.replace("k_volume", "k_volum"), "pbs.k_volum = 1.0: unknown key; the nearest known one is pbs.k_volume"
    yield "unknown_table", SCENE.replace("[motion]", "[movement]"), "unknown key; the nearest known one is motion"
    yield "key_left_out", SCENE.replace("k_bind = 1.0\n", ""), "pbs.k_bind: missing"
    yield "stiffness_beyond_one", SCENE.replace("k_volume = 1.0", "k_volume = 1.4"), ":12: pbs.k_volume = 1.4: " + UNIT
    yield "nan_stiffness", SCENE.replace("k_volume = 1.0", "k_volume = nan"), ":12: pbs.k_volume = nan: " + UNIT
    yield "stiffness_beyond_double", SCENE.replace("k_volume = 1.0", "k_volume = 1e400"), ":12: " + PARSING + "floating-point"
    yield "a_word_for_a_number", SCENE.replace("k_volume = 1.0", 'k_volume = "stiff"'), ":12: pbs.k_volume = stiff: " + UNIT
    yield "a_date_for_a_number", SCENE.replace("frames = 5", "frames = 1979-05-27"), WHOLE + "2 to 1000000"
    yield "gravity_of_two_numbers", SCENE.replace("[0.0, 0.0, 0.0]", "[0.0, 0.0]"), "pbs.gravity_m_s2 = [0.0,0.0]: expected three numbers"
    yield "no_axis", SCENE.replace("[0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0]"), "motion.axis = [0.0,0.0,0.0]: expected an axis of non-zero length"
    yield "no_frames", SCENE.replace("frames = 5", "frames = 0"), ":9: motion.frames = 0: " + WHOLE + "2 to 1000000"
    yield "frames_beyond_int", SCENE.replace("frames = 5", "frames = 2147483648"), "motion.frames = 2147483648: " + WHOLE + "2 to 1000000"
    yield "frames_beyond_long", SCENE.replace("frames = 5", "frames = 9223372036854775808"), ":9: " + PARSING + "decimal integer"
    yield "unknown_joint", SCENE.replace('"elbow"', '"knee"'), "motion.joint = knee: expected one of shoulder, elbow"
    yield "unknown_body", SCENE.replace('mesh = "arm.vtu"', 'body = "dragon"'), ":3: character.body = dragon: expected one of "
    yield "unknown_deformer", SCENE.replace('"dqs"', '"spline"'), "expected a deformer of `pbskin list deformers`"
    yield "mesh_that_is_not_there", SCENE.replace("arm.vtu", "none.vtu"), "none.vtu: no such file"
    yield "skeleton_that_is_not_there", SCENE.replace("arm.skeleton", "none.skeleton"), "none.skeleton.toml: cannot be opened: "
    yield "key_twice", SCENE.replace("frames = 5", "frames = 5\nframes = 6"), ":10: " + PARSING + "key-value pair: cannot redefine"
    yield "nested_keys", "a." * 60000 + "a = 1\n", DEEP
    yield "nested_keys_of_an_inline_table", SCENE + "x = {" + "a." * 60000 + "a = 1}\n", DEEP
    yield "nested_tables", SCENE + "x = " + "{a = " * 5000, ":17: " + PARSING + "value: exceeded maximum nested value depth"
    yield "ten_megabytes_of_brackets", "[" * 10_000_000, ":1: " + PARSING + "key: expected bare key"
    yield "text_behind_a_word", SCENE.replace("1.0", '1.0"\u0372"', 1), "expected a text apart from what is before it"
    yield "zero_byte", SCENE.encode() + b"\0", "byte = 0: expected ASCII outside of texts"


def settings():
    for setting, words in (("pbs.iterations=-1", "--set: pbs.iterations = -1: " + WHOLE + "0 to 1000000"),
                           ("pbs.time_step_s=1e-300", "pbs.time_step_s = 1e-300: expected a number from"),
                           ("pbs.time_step_s=0", "pbs.time_step_s = 0: expected a number from"),
                           ("motion.frames=99999999999", "motion.frames = 99999999999: " + WHOLE + "2 to 1000000"),
                           ("nonsense", "expected key=value"),
                           ("pbs.k_bind=" + "[" * 50000, UNIT), ("pbs.k_bind=" + "a." * 50000 + "=1", UNIT),
                           ("pbs.k_bind={x=1," + "a." * 50000 + "a=1}", UNIT),
                           ("output.frames=[99]", "output.frames = 99: expected less than the motion's 5 frames"),
                           ("fem.0.name=../x", "the scene has no such [[fem]] table"),
                           ("fem.99999999999.poisson=0.1", "the scene has no such [[fem]] table")):
        yield Case(f"setting {setting[:30]}", {}, ["run", "arm.toml", "-o", "out", "--set", setting], (words,))


def cases():
    for name, content, words in scenes():
        place = () if ".toml: " in words or "none" in words else ("bad.toml:",)
        yield Case(f"scene {name}", {"bad.toml": content}, ["run", "bad.toml", "-o", "out"], (*place, words))
    yield from settings()
