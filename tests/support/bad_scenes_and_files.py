"""Scenes and commands that are refused, and files that are none: folders, pipes, loops, names without end, places that cannot be
written."""
import os
import threading

import foreign_arm
from bad_characters import SCENE, bvh
from bad_case import Case
from bad_tets import NOISE

CLIP_SCENE = SCENE.replace('joint = "elbow"\naxis = [0.0, 0.0, 1.0]\nangle_deg = 120.0\nframes = 5\n', 'clip = "good.bvh"\n')
COMMON_CLIP = bvh("3", motion=3 * "0 0 0 0 0 0 10 20 30\n")


def scenes():
    yield "empty", "", "schema: missing"
    yield "noise", NOISE, ":1: "
    yield "truncated", SCENE[:50], "bad.toml:4: "
    yield "no_schema", SCENE.replace("schema = 1\n", ""), "schema: missing"
    yield "schema_of_tomorrow", SCENE.replace("schema = 1", "schema = 2"), ":1: schema = 2"
    yield "unknown_key", SCENE.replace("k_volume", "k_volum"), "pbs.k_volum = 1.0: unknown key; the nearest known one is pbs.k_volume"
    yield "unknown_table", SCENE.replace("[motion]", "[movement]"), "unknown key; the nearest known one is motion"
    yield "key_left_out", SCENE.replace("k_bind = 1.0\n", ""), "pbs.k_bind: missing"
    yield "stiffness_beyond_one", SCENE.replace("k_volume = 1.0", "k_volume = 1.4"), ":12: pbs.k_volume = 1.4"
    yield "nan_stiffness", SCENE.replace("k_volume = 1.0", "k_volume = nan"), ":12: pbs.k_volume = nan"
    yield "a_word_for_a_number", SCENE.replace("k_volume = 1.0", 'k_volume = "stiff"'), ":12: pbs.k_volume = stiff"
    yield "gravity_of_two_numbers", SCENE.replace("[0.0, 0.0, 0.0]", "[0.0, 0.0]"), ":14: pbs.gravity_m_s2"
    yield "no_axis", SCENE.replace("[0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0]"), ":7: motion.axis"
    yield "no_frames", SCENE.replace("frames = 5", "frames = 0"), ":9: motion.frames = 0"
    yield "unknown_joint", SCENE.replace('"elbow"', '"knee"'), "motion.joint = knee: expected one of shoulder, elbow"
    yield "unknown_body", SCENE.replace('mesh = "arm.vtu"', 'body = "dragon"'), ":3: character.body = dragon"
    yield "unknown_deformer", SCENE.replace('"dqs"', '"spline"'), ":16: deformers.use"
    yield "mesh_that_is_not_there", SCENE.replace("arm.vtu", "none.vtu"), "none.vtu: no such file"
    yield "skeleton_that_is_not_there", SCENE.replace("arm.skeleton", "none.skeleton"), "none.skeleton.toml: cannot be opened"
    yield "key_twice", SCENE.replace("frames = 5", "frames = 5\nframes = 6"), ":10: "
    yield "nested_keys", "a." * 60000 + "a = 1\n", ":1: key = a.a."
    yield "nested_tables", SCENE + "x = " + "{a = " * 5000, ":17: "
    yield "ten_megabytes_of_brackets", "[" * 10_000_000, ":1: "


def settings():
    for setting, words in (("pbs.iterations=-1", "--set: pbs.iterations = -1"),
                           ("pbs.time_step_s=1e-300", "pbs.time_step_s = 1e-300: expected a number from"),
                           ("pbs.time_step_s=0", "pbs.time_step_s = 0"), ("motion.frames=99999999999", "motion.frames"),
                           ("nonsense", "expected key=value"),
                           ("pbs.k_bind=" + "[" * 50000, "--set: pbs.k_bind"), ("pbs.k_bind=" + "a." * 50000 + "=1", "--set: pbs.k_bind"),
                           ("output.frames=[99]", "output.frames = 99: expected less than the motion's 5 frames"),
                           ("fem.0.name=../x", "the scene has no such [[fem]] table")):
        yield Case(f"setting {setting[:30]}", {}, ["run", "arm.toml", "-o", "out", "--set", setting], (words,))


def vanishing(path):
    """A named pipe: there when it is looked for, and nothing ever to read."""
    os.mkfifo(path)


def loop(path):
    path.symlink_to(path.name)


def locked(path):
    """A folder that is read-only."""
    path.mkdir(mode=0o555)


def secret(path):
    path.write_text(SCENE)
    path.chmod(0)


def strange_files():
    kinds = (("folder", os.mkdir), ("named_pipe", vanishing), ("symlink_loop", loop),
             ("link_to_nothing", lambda path: path.symlink_to("nowhere")))
    for kind, make in kinds:
        for what, file, command in (("mesh", "x.vtu", ["measure", "x.vtu", "x.vtu"]),
                                    ("surface", "x.obj", ["mesh", "x.obj", "-o", "t.vtu"]),
                                    ("scene", "x.toml", ["run", "x.toml", "-o", "out"]),
                                    ("skeleton", "x.skeleton", ["run", "arm.toml", "-o", "out", "--set", "character.skeleton=x.skeleton"]),
                                    ("weights", "x.csv", ["run", "arm.toml", "-o", "out", "--set", "skinning.weights=x.csv"]),
                                    ("clip", "x.bvh", ["run", "clip.toml", "-o", "out", "--set", "motion.clip=x.bvh"])):
            yield Case(f"{kind} as a {what}", {file: make}, command, ("x.",) if what != "clip" else ("motion.clip",))
    long = "x" * 5000
    for number, command in enumerate((["measure", long + ".vtu", "arm.vtu"], ["mesh", long + ".obj", "-o", "t.vtu"],
                                      ["run", long + ".toml", "-o", "out"], ["report", long],
                    ["reproduce", "--judge", "-o", long], ["run", "arm.toml", "-o", long])):
        yield Case(f"name of 5000 characters {number}", {}, command, (long[:100],))


def places():
    yield Case("output folder that is a file", {"out": "text"}, ["run", "arm.toml", "-o", "out"], ("out", "cannot be made"))
    yield Case("output folder under a file", {"out": "text"}, ["run", "arm.toml", "-o", "out/deeper"], ("out/deeper", "cannot be made"))
    yield Case("output in /proc", {}, ["run", "arm.toml", "-o", "/proc/pbskin"], ("/proc/pbskin", "cannot be made"))
    yield from read_only_places()
    yield Case("figures onto a full disk", {}, ["measure", "arm.vtu", "arm.vtu", "--csv", "/dev/full/x.csv"], ("/dev/full/x.csv",))
    yield Case("figures into a folder that is not there", {}, ["measure", "arm.vtu", "arm.vtu", "--csv", "none/x.csv"], ("none/x.csv",))
    yield Case("bench into a file", {"out": "text"}, ["bench", "--quick", "-o", "out"], ("out", "cannot be made"))


def read_only_places():
    for number, (place, command) in enumerate((("locked", ["run", "arm.toml", "-o"]), ("locked/deeper", ["run", "arm.toml", "-o"]),
                                               ("locked/x.csv", ["measure", "arm.vtu", "arm.vtu", "--csv"]),
                                               ("locked/x.xml", ["measure", "arm.vtu", "arm.vtu", "--junit"]),
                                               ("locked", ["bench", "--quick", "-o"]), ("locked", ["reproduce", "momentum", "-o"]))):
        yield Case(f"read-only folder {number}", {"locked": locked}, [*command, place], (place, "ermission denied"), as_nobody=True)
    for file, command in (("x.toml", ["run", "x.toml", "-o", "out"]), ("x.vtu", ["measure", "x.vtu", "arm.vtu"]),
                          ("y.vtu", ["measure", "arm.vtu", "y.vtu"]), ("x.obj", ["mesh", "x.obj", "-o", "tets.vtu"]),
                          ("x.csv", ["run", "arm.toml", "-o", "out", "--set", "skinning.weights=x.csv"])):
        yield Case(f"{file} that must not be read", {file: secret}, command, (file,), as_nobody=True)


def command_lines():
    yield Case("no verb", {}, [], ("pbskin",))
    yield Case("unknown verb", {}, ["dance"], ("A subcommand is required",))
    yield Case("threads out of range", {}, ["run", "arm.toml", "--threads", "0"], ("--threads",))
    yield Case("unknown study", {}, ["reproduce", "alchemy", "-o", "out"], ("reproduce = alchemy: unknown claim or study",))
    yield Case("fetch an unknown body", {}, ["fetch", "dragon"], ("dragon",))


def cases():
    for name, content, words in scenes():
        yield Case(f"scene {name}", {"bad.toml": content}, ["run", "bad.toml", "-o", "out"], (words,))
    yield from settings()
    yield from strange_files()
    yield from places()
    yield from command_lines()
