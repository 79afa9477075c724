"""The files below a folder of records: whether each is complete, and its content except time and provenance."""
import csv
import io
import json
import os
import pathlib
import re
from xml.etree import ElementTree

import program

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


def state_hashes(records):
    """`RUN/run.json DEFORMER` -> hash, for the records of a folder."""
    return {f"{name} {label}": state for name, record in records.items() if name.endswith("run.json")
            for label, state in record.get("state_hash", {}).items()}


def junit_cases(path):
    """The test cases of a JUnit report, by classname and name."""
    found = {}
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        key = case.get("classname"), case.get("name")
        assert key not in found, key
        found[key] = case
    return found


def failed_cases(path):
    """Classname and name of each case with a <failure> or an <error>."""
    return {key for key, case in junit_cases(path).items() if case.find("failure") is not None
            or case.find("error") is not None}


def scenes_of_another_mesh(folder):
    """The scenes of a check's folder whose counts of vertices and tets differ from the project's baseline, as with
    another version of CGAL."""
    with open(os.path.join(program.SOURCE, "experiments", "verdicts", "check", "check_baseline.csv"), encoding="utf-8",
              newline="") as file:
        baseline = {row["scene"]: (int(row["vertices"]), int(row["tets"])) for row in csv.DictReader(file)}
    others = set()
    for scene, counts in baseline.items():
        with open(os.path.join(folder, scene, "run.json"), encoding="utf-8") as file:
            character = json.load(file)["character"]
        if (character["vertices"], character["tets"]) != counts:
            others.add(scene)
    return others


def baselines_of(scenes, path):
    """The cases of a JUnit report that compare one of the scenes with the baseline."""
    return {(scene, name) for scene, name in junit_cases(path) if scene in scenes and name.startswith("baseline of ")}
