"""The files below a folder of records: whether each is complete, and its content except time and provenance."""
import csv
import io
import json
import pathlib
import re
from xml.etree import ElementTree

TIME_COLUMNS = re.compile(r"step_ms|.*cpu_s|.*wall_s|.*seconds|.*_ns|ms_.*|ns_.*")
TIMED = "analyse|assemble|assembly|character|cost|cpu|factor|mesh|records|set_?up|solve|timing|total|wall"
TIME_KEYS = re.compile(rf"provenance|peak_memory_mb|.*seconds|.*_utc|(.*_)?({TIMED})_s|.*frames_per_s|gb_s")
ENDS = {".html": r"</html>\s*", ".md": r"\n", ".msh": r"\$End\w+\n", ".mesh": r"End\s*", ".py": r"\n", ".toml": r"\n"}
TEMPORARY = re.compile(r"\..+\.\d+\.[A-Za-z0-9]{6}")


def files(folder):
    return sorted(path for path in pathlib.Path(folder).rglob("*") if path.is_file())


def is_temporary(path):
    return TEMPORARY.fullmatch(path.name) is not None


def rows(path):
    text = path.read_text(encoding="utf-8")
    if not text.endswith("\n"):
        raise ValueError("the last line has no end")
    table = list(csv.reader(io.StringIO(text)))
    if {len(row) for row in table} != {len(table[0])}:
        raise ValueError("lines of unequal length")
    return table


def what_is_torn(path):
    """Why a file is incomplete; nothing if it is complete."""
    try:
        if path.suffix == ".csv":
            rows(path)
        elif path.suffix == ".json":
            json.loads(path.read_text(encoding="utf-8"))
        elif path.suffix in (".vtu", ".vtp", ".pvd"):
            ElementTree.parse(path)
        elif not re.search(rf"(?s:.){ENDS.get(path.suffix, '')}$", path.read_bytes().decode(errors="replace")):
            raise ValueError("empty, or without its end")
    except (ValueError, ElementTree.ParseError) as error:
        return f"{path}: {error}"
    return None


def without_time(value):
    if isinstance(value, dict):
        return {key: without_time(of) for key, of in value.items() if not TIME_KEYS.fullmatch(key)}
    return [without_time(of) for of in value] if isinstance(value, list) else value


def said(path):
    if path.suffix == ".json":
        return without_time(json.loads(path.read_text(encoding="utf-8")))
    if path.suffix == ".csv":
        table = rows(path)
        kept = [column for column, name in enumerate(table[0]) if not TIME_COLUMNS.fullmatch(name)]
        return [[row[column] for column in kept] for row in table]
    return path.read_bytes()


def records(folder, left_out=()):
    """Name below the folder -> content of the file."""
    named = ((str(path.relative_to(folder)), path) for path in files(folder))
    return {name: said(path) for name, path in named if not name.endswith(tuple(left_out))}
