"""The files that a scene's texts name: mesh, skeleton, clip, weights. A run is the result of what they hold, and so is its name."""
import functools
import hashlib
import pathlib
import tomllib

COMPANIONS = {".ele": ".node", ".gltf": ".bin"}  # one file in two


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


def files_of(values, folder):
    """Name -> hash for those of the values that name a file in the scene's folder; of a built-in scene, folder None, by absolute paths."""
    found = {}
    for text in texts_of(values):
        path = pathlib.Path(folder or "", text)
        companion = COMPANIONS.get(path.suffix)
        parts = {text: path, **({str(pathlib.Path(text).with_suffix(companion)): path.with_suffix(companion)} if companion else {})}
        found |= {name: sha256(part) for name, part in parts.items() if part.is_absolute() and is_file(part)}
    return found


def scene_values(file):
    """Of a scene file; none where it is no TOML, which pbskin refuses."""
    try:
        return tomllib.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError):
        return {}
