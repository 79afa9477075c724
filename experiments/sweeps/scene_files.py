"""The files that a scene's texts name: mesh, skeleton, clip, weights. A run is the result of what they hold, and so is its name."""
import functools
import hashlib
import json
import pathlib
import tomllib

COMPANIONS = {".ele": ".node", ".node": ".ele"}  # one mesh in two files, named by either


def texts_of(value):
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from texts_of(part)


@functools.cache
def sha256(path):
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def is_file(path):
    try:
        return path.is_file()
    except OSError:  # a text too long for a name
        return False


def buffers_of(path):
    """What a glTF's buffers name, those inside it left out; nothing where it is no glTF, which pbskin refuses."""
    try:
        named = [buffer.get("uri", "") for buffer in json.loads(path.read_text(encoding="utf-8"))["buffers"]]
        return [uri for uri in named if uri and not uri.startswith("data:")]
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return []


def companions_of(path):
    """Names, in the file's own folder, of what it is read with."""
    if path.suffix == ".gltf":
        return buffers_of(path)
    return [path.with_suffix(COMPANIONS[path.suffix]).name] if path.suffix in COMPANIONS else []


def files_of(values, folder):
    """Name -> hash for those of the values that name a file in the scene's folder; of a built-in scene, folder None, by absolute paths."""
    found = {}
    for text in texts_of(values):
        path = pathlib.Path(folder or "", text)
        if path.is_absolute() and is_file(path):
            found[text] = sha256(path)
        beside = {str(pathlib.Path(text).parent / name): path.parent / name for name in companions_of(path)} if path.is_absolute() else {}
        found |= {name: sha256(part) for name, part in beside.items() if is_file(part)}
    return found


def scene_values(file):
    """Of a scene file; none where it is no TOML, which pbskin refuses."""
    try:
        return tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError):
        return {}
