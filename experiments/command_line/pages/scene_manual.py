"""The manual of scene files, from the program's own list of keys: a page of Markdown, experiments/scene/manual.md, and
pbskin-scene(5).

    text = scene_manual.markdown(program["scene_keys"])
"""
from man_page import escaped, title_line

introduction = (
    "A scene is one TOML file. It names a character, what moves it, the deformers to compare and what is written.",
    "`pbskin run SCENE.toml` runs it, and `--set pbs.iterations=96` replaces one value for one run.",
    "Paths in a scene are relative to the scene file.",
    "An unknown key, a wrong type or a value outside its range ends with exit status 2. The message names the file, "
    "the line, the key, the value and the rule, and for an unknown key the nearest known one.",
    "A key without a default must be stated as soon as a deformer of the scene uses it.")

tables = {
    "": "Keys at the top of the file.",
    "character": "The body: a built-in one, an installed one, or files of your own.",
    "motion": "What moves the character: one joint that turns (a sweep), joints through their range of motion, "
              "or a motion capture clip.",
    "skinning": "The skinning weights.",
    "pbs": "Position based skinning, as in Algorithm 1 of the paper.",
    "pbs.jiggle": "The jiggling zone. It is off unless this table is present.",
    "pbs.variant": "Other readings and the printed forms of the paper's equations.",
    "pbs.improved": "Changes to the paper's method, which the study `work_precision` compares; the defaults are the "
                    "paper's.",
    "pbs_author": "Position based skinning as in the code that the paper's first author published in 2018.",
    "xpbd": "Extended position based dynamics: the deformers `xpbd` and `xpbd_small_steps`.",
    "delta_mush": "Delta mush: smoothing after linear blend skinning.",
    "fem": "A finite element reference. Each `[[fem]]` table adds a deformer of that name.",
    "reference": "The deformer against which errors are measured.",
    "deformers": "Which deformers run.",
    "output": "What a run writes."}

further = {
    "Skeleton files": (
        "A skeleton is a TOML file with one `[[joint]]` table per bone: `name`, `parent` (empty for a root), "
        "`head_m` and "
        "`tail_m`, the end points of the bone at rest in metres.",
        "Rest rotations are the identity, so axes are those of the world.",
        "A clip (.bvh, .gltf, .glb, .fbx, .dae, .zae) can serve as skeleton, in its rest pose: the zero pose, "
        "or a T or A pose in the first frame."),
    "Weight files": (
        "A CSV file with the columns `vertex`, `joint` and `weight`. The weights of a vertex add up to 1.",),
    "Rigged models": (
        "Accepted with a warning: points that no triangle uses, and the second side of a shell whose triangles are all "
        "there once more in the reverse order (both are left out); weights that are no numbers, at up to 1 % of a "
        "mesh's points (they take those of their neighbours).",
        "Refused: weights that are no numbers at more points, inverse bind matrices stored by rows, an animated node "
        "with a matrix, and a required extension that nodes, meshes, animations or buffers of a glTF file have, "
        "such as the compression of Draco."),
    "Meshes and surfaces": (
        "Tet meshes are read from .msh (Gmsh 1 to 2.2, 4.0 and 4.1), .vtu, .pvtu, .vtk, .mesh (MEDIT) and .node with "
        ".ele (TetGen).",
        "`pbskin mesh` makes one from a surface (.obj, .ply, .off, .stl, .gltf).",
        "The nodes of a .msh are numbered from 0 by ascending tag. A file that lists them in another order gets a "
        "warning: weights by vertex follow the tags, and frames for `pbskin measure` may follow either order.",
        "The reader is chosen by the content of a file where it shows the format. A file with the extension of another "
        "format gets a warning.",
        "Coordinates are in metres. A body of less than 1 mm or more than 100 m gets a warning, for files do not "
        "state a unit.",
        "Accepted with a warning: a tet mesh of several parts (each is skinned by itself); parts that touch in a "
        "vertex or an edge alone (they are separated there; `pbskin measure` keeps the file's vertices); "
        "unused vertices (they are left out); inverted tets (they are turned back); a tet that is listed twice (it "
        "counts once); a sliver, a nearly flat tet (it stays, and is named); a surface with unused points or triangles "
        "without area (they are left out), with holes or crossing triangles (it is wrapped), with closed cavities "
        "(they are filled), or facing inwards.",
        "Refused: an index out of range, a coordinate that is not a number, an edge of a surface in three or more "
        "triangles, a surface without volume, a triangle that occurs twice; in a tet mesh two vertices at one place, "
        "or a boundary that intersects itself.",
        "Points of a surface at the same place are joined without a message, since exporters split them at "
        "texture seams.")}


def grouped(keys):
    """Table -> its keys in the order of the program: the tables above first and in their order, then any others by
    name."""
    found = {}
    for key in keys:
        found.setdefault(key["table"], []).append(key)
    order = list(tables)
    return {table: found[table]
            for table in sorted(found, key=lambda name: (order.index(name) if name in order else len(order), name))}


def heading(table, keys):
    return "Top level" if not table else f"[[{table}]]" if keys[0]["in_list"] else f"[{table}]"


def default_of(key):
    return key["default"] or "none"


def rule_of(key):
    return key["rule"].removeprefix("expected ") + (f" [{key['unit']}]" if key["unit"] else "")


def markdown(keys):
    lines = ["# Scene files: every key", "",
             "<!-- Written by experiments/command_line/pages/scene_manual.py from the program's own list. -->",
             "", *introduction]
    for table, of_table in grouped(keys).items():
        lines += ["", f"## {heading(table, of_table)}", "", *([tables[table], ""] if table in tables else []),
                  "| key | default | value [unit] | meaning |", "|---|---|---|---|"]
        for key in of_table:
            cells = (f"`{key['name']}`", f"`{default_of(key)}`" if key["default"] else "none", rule_of(key),
                     key["meaning"])
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    for title, sentences in further.items():
        lines += ["", f"## {title}", "", *(f"- {sentence}" for sentence in sentences)]
    return "\n".join(lines) + "\n"


def man(keys, version):
    lines = [title_line("PBSKIN-SCENE", 5, version, "File Formats"), ".SH NAME",
             "pbskin-scene \\- scene files of pbskin", ".SH DESCRIPTION",
             *(escaped(line.replace("`", "")) for line in introduction)]
    for table, of_table in grouped(keys).items():
        lines += [".SH " + escaped(heading(table, of_table) if table else "TOP LEVEL"),
                  escaped(tables.get(table, "").replace("`", ""))]
        for key in of_table:
            lines += [".TP", f"\\fB{escaped(key['name'])}\\fR", escaped(f"{key['meaning']}."),
                      escaped(f"Value: {rule_of(key)}. Default: {default_of(key)}.")]
    for title, sentences in further.items():
        lines += [f".SH {title.upper()}", *(escaped(line.replace("`", "")) for line in sentences)]
    return "\n".join([*filter(None, lines), ".SH SEE ALSO", "\\fBpbskin\\fR(1)"]) + "\n"
