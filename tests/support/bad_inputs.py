"""The bad inputs of bad_*.toml, and those that are accepted, some with a remark. Each row of a `group` is

    [name, what stderr must contain, how the content of the file differs from the sound one]

What stderr must contain, besides the file's name, is a text for all `variants` (formats of the file, or verbs), or a
list of texts, each behind its variants. A content is the name of a sound file (sound_files.py), `@` and the name of
something special, or a table: it begins as `text`, as `parts` put together, or as a sound file, whose writer is called
`with` other arguments. `scale` changes the points of a mesh; `set` and `drop` change the numbers of a mesh or of a glTF
document by their paths, and `put` bytes of the accessor at a path, from this byte on. Then `replace`, `begin`, `end` (a
number of bytes, or a share), `before` and `after` change the whole. A part is a text, a repeated text, packed numbers,
or `@noise`. Each row of a `case` is [name, command, what stderr must contain, files, further members of the case]."""
import concurrent.futures
import copy
import os
import pathlib
import struct
import tomllib

import bad_case
import sound_files
from sound_files import COMMON

TABLES = sorted(pathlib.Path(__file__).parent.glob("bad_*.toml"))
WORDS = {"long": "x" * 5000, "brackets": "[" * 50000, "keys": "a." * 50000}  # of commands


def sparse(path):
    """64 GB of zeros that occupy no space on disk."""
    path.touch()
    os.truncate(path, 1 << 36)


def secret(path):
    path.write_text(sound_files.SCENE)
    path.chmod(0)


JOINT = '[[joint]]\nname = "j%d"\nparent = ""\nhead_m = [%d, 0, 0]\ntail_m = [%d, 0, 0]\n'
SPECIAL = {"thousands_of_joints": "".join(JOINT % (i, i, i + 1) for i in range(2500)).encode(),
           "noise": sound_files.NOISE, "sparse": sparse, "secret": secret, "folder": os.mkdir, "pipe": os.mkfifo,
           "locked": lambda path: path.mkdir(mode=0o555), "closed": lambda path: path.mkdir(mode=0),
           "loop": lambda path: path.symlink_to(path.name),
           "link_to_nothing": lambda path: path.symlink_to("nowhere"),
           "endless": lambda path: path.symlink_to("/dev/zero"), "null": lambda path: path.symlink_to("/dev/null")}


def joined(parts, encoding="utf-8"):
    """The bytes of a text, or of a list of parts."""
    if isinstance(parts, str):
        return sound_files.NOISE if parts == "@noise" else parts.encode(encoding)
    if isinstance(parts, dict):
        return struct.pack(*parts["pack"])
    if len(parts) == 2 and isinstance(parts[1], int):
        return joined(parts[0], encoding) * parts[1]
    return b"".join(joined(part, encoding) for part in parts)


def pairs(value):
    """A list of lists, also of a single one."""
    return [value] if value and not isinstance(value[0], list) else value


def place(root, path):
    """The container and the key of the value with this path; an index behind the last is that of a new element."""
    *above, last = [int(name) if name.isdigit() else name for name in path.split(".")]
    for number, name in enumerate(above):
        root[name] = list(root[name]) if isinstance(root[name], tuple) else root[name]
        root = root[name]
    if isinstance(root, list) and last == len(root):
        root.append(None)
    return root, last


def changed(arguments, change):
    """The arguments of a writer with another point, cell, or part of the glTF document."""
    arguments = copy.deepcopy(arguments)
    root = arguments.get("document", arguments)
    if "scale" in change:
        arguments["points"] = [[change["scale"] * x for x in point] for point in arguments["points"]]
    for path, value in pairs(change.get("set", [])):
        container, key = place(root, path)
        container[key] = value
    for path in change.get("drop", []):
        container, key = place(root, path)
        del container[key]
    if "put" in change:
        path, at, *numbers = change["put"]
        container, key = place(root, path)
        view = root["bufferViews"][root["accessors"][container[key]]["bufferView"]]
        struct.pack_into(numbers[0], arguments["data"], view["byteOffset"] + at, *numbers[1:])
    return arguments | change.get("with", {})


def content(change, sound=None):
    """Bytes, or a function that makes the file from its path."""
    if isinstance(change, str):
        if change.startswith("@"):
            return SPECIAL[change[1:]]
        change = {"sound": change}
    encoding = change.get("encoding", "utf-8")
    if "text" in change or "parts" in change:
        whole = joined(change.get("text", change.get("parts")), encoding)
    else:
        write, arguments = sound_files.SOUND[change.get("sound", sound)]
        whole = write(**changed(arguments, change))
        whole = whole if isinstance(whole, bytes) else whole.encode()
    for old, new in pairs(change.get("replace", [])):
        whole = whole.replace(old.encode(encoding), joined(new, encoding))
    end = change.get("end")
    if isinstance(end, str):  # a share
        of, over = map(int, end.split("/"))
        end = len(whole) * of // over
    return joined(change.get("before", "")) + whole[change.get("begin", 0):end] + joined(change.get("after", ""))


def of_group(group):
    for row, says, *rest in group["rows"]:
        told = [[*group.get("variants", [""]), says]] if isinstance(says, str) else says
        for variant, text in ((variant, text) for *variants, text in told for variant in variants):
            change = rest[0] if rest else {}
            change = "@" + variant if change == "@{variant}" else change
            file = group["file"].format(extension=variant.split(" ")[0])
            command = group["command"][variant] if isinstance(group["command"], dict) else group["command"]
            files = ({f"records/momentum/{name}": of for name, of in sound_files.STUDY.items()} if "beside" in group
                     else {})
            files[file] = content(change, group.get("sound", "").format(variant=variant))
            yield bad_case.Case(group["name"].format(row=row, variant=variant), files,
                                command.format(file=file).split(), (group.get("place", f"{file}:"), text),
                                as_nobody=variant == "secret")


def of_cases(table):
    for name, words, says, *rest in table["rows"]:
        files, more = [*rest, {}, {}][:2]
        command = table.get("command", "{words}").format(name=name, words=words).format(**WORDS).split()
        says = [table.get("place", ""), *([says] if isinstance(says, str) else says)]
        files = {file: content(of) for file, of in (table.get("beside", {}) | files).items()}
        options = {key: {**table, **more}[key] for key in ("status", "as_nobody", "leaves") if key in {**table, **more}}
        yield bad_case.Case(table.get("name", "{name}").format(name=name), files, command, tuple(says),
                            **options | {"leaves": tuple(options.get("leaves", ()))})


def cases():
    for path in TABLES:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        for group in tables.get("group", []):
            yield from of_group(group)
        for table in tables.get("case", []):
            yield from of_cases(table)


def refused():
    return [case for case in cases() if case.status == 2]


def accepted():
    return [case for case in cases() if case.status == 0]


def wrong_answers(cases):
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        return [problem for found in pool.map(lambda case: bad_case.problems(case, COMMON), cases) for problem in found]
