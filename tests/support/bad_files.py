"""Inputs that are not regular files: folders, pipes, loops, endless names; files that must not be read; and texts after a byte-order
mark."""
import os

import bad_surfaces
import foreign_arm
import tet_texts
from bad_characters import SCENE, WEIGHTS, bvh
from bad_case import Case
from bad_tets import POINTS, TETS

BYTE_ORDER_MARK = "\ufeff"
USES = {"mesh": ("x.vtu", ["measure", "x.vtu", "x.vtu"]), "surface": ("x.obj", ["mesh", "x.obj", "-o", "t.vtu"]),
        "scene": ("x.toml", ["run", "x.toml", "-o", "out"]),
        "skeleton": ("x.skeleton", ["run", "arm.toml", "-o", "out", "--set", "character.skeleton=x.skeleton"]),
        "weights": ("x.csv", ["run", "arm.toml", "-o", "out", "--set", "skinning.weights=x.csv"]),
        "clip": ("x.bvh", ["run", "clip.toml", "-o", "out", "--set", "motion.clip=x.bvh"])}
KINDS = {"folder": os.mkdir, "named_pipe": os.mkfifo, "symlink_loop": lambda path: path.symlink_to(path.name),
         "link_to_nothing": lambda path: path.symlink_to("nowhere"), "device": lambda path: path.symlink_to("/dev/zero")}
NO_FILE, NOT_OPEN = "expected a file", "cannot be opened: "
REASONS = {"folder": NOT_OPEN + NO_FILE, "named_pipe": NOT_OPEN + NO_FILE, "device": NOT_OPEN + NO_FILE,
           "symlink_loop": NOT_OPEN + "Too many levels of symbolic links", "link_to_nothing": NOT_OPEN + "No such file or directory"}


def reason(kind, use):
    if use == "scene":
        return "cannot be read: expected a scene file, or a name of `pbskin list scenes`"
    if use == "clip":
        return "motion.clip = x.bvh: expected a file in the folder of the scene"
    if use in ("skeleton", "weights"):
        return REASONS[kind]
    if kind in ("symlink_loop", "link_to_nothing"):
        return "no such file"
    return "no such frames" if (kind, use) == ("folder", "mesh") else NO_FILE


def strange_files():
    for kind, make in KINDS.items():
        for use, (file, command) in USES.items():
            place = "--set: " if use == "clip" else file + ": "
            yield Case(f"{kind} as a {use}", {file: make}, command, (place, reason(kind, use)))


def long_names():
    long = "x" * 5000
    for number, (command, rule) in enumerate(((["measure", long + ".vtu", "arm.vtu"], "no such file"),
                                              (["mesh", long + ".obj", "-o", "t.vtu"], "no such file"),
                                              (["run", long + ".toml", "-o", "out"], "cannot be read: expected a scene file"),
                                              (["report", long], "File name too long"),
                                              (["reproduce", "--judge", "-o", long], "File name too long"),
                                              (["run", "arm.toml", "-o", long], "cannot be made: File name too long"))):
        yield Case(f"name of 5000 characters {number}", {}, command, (long[:40], rule))


def secret(path):
    path.write_text(SCENE)
    path.chmod(0)


def secrets():
    unread = {"scene": NOT_OPEN + "Permission denied", "mesh": "cannot be read", "surface": "cannot be read",
              "skeleton": NOT_OPEN + "Permission denied", "weights": NOT_OPEN + "Permission denied"}
    for use, rule in unread.items():
        file, command = USES[use]
        yield Case(f"a {use} that must not be read", {file: secret}, command, (file + ": ", rule), as_nobody=True)
    yield Case("a frame that must not be read", {"x.vtu": secret}, ["measure", "arm.vtu", "x.vtu"], ("x.vtu: ", "cannot be read"),
               as_nobody=True)


def byte_order_marks():
    """Programs of Windows write such a mark; the message names it, so that the author can save the file without it."""
    bytes_of_toml, run = ":1: byte = 239: expected ASCII outside of texts", ["run", "arm.toml", "-o", "out", "--set"]
    for file, text, command, words in (
            ("bad.toml", SCENE, ["run", "bad.toml", "-o", "out"], bytes_of_toml),
            ("bad.skeleton", foreign_arm.SKELETON, [*run, "character.skeleton=bad.skeleton"], bytes_of_toml),
            ("bad.csv", WEIGHTS, [*run, "skinning.weights=bad.csv"], ":1: expected the header vertex,joint,weight"),
            ("bad.bvh", bvh(), ["run", "clip.toml", "-o", "out", "--set", "motion.clip=bad.bvh"], "Expected header string"),
            ("bad.msh", tet_texts.msh(POINTS, TETS), ["measure", "bad.msh", "bad.msh"], "expected a Gmsh file beginning with $MeshFormat"),
            ("bad.vtk", tet_texts.vtk(POINTS, TETS), ["measure", "bad.vtk", "bad.vtk"], "Error parsing XML in stream at line 1"),
            ("bad.obj", bad_surfaces.obj(), ["mesh", "bad.obj", "-o", "t.vtu"], "OBJ: vertex index out of range"),
            ("bad.off", bad_surfaces.off(), ["mesh", "bad.off", "-o", "t.vtu"], "damaged: CGAL read 0 points and 0 faces")):
        yield Case(f"byte-order mark in {file}", {file: BYTE_ORDER_MARK + text}, command, (file + ":", words))


def cases():
    yield from byte_order_marks()
    yield from strange_files()
    yield from long_names()
    yield from secrets()
