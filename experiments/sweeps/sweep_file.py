"""A sweep: one scene, some of its keys with several values, and the runs that this makes. From a TOML file, whose keys are the scene's:

    schema = 1
    scene = "human_01_01"               # built in, or a scene file beside this one
    [set]                               # the same in every run
    motion.duration_s = 0.3
    [grid]                              # every combination, the last key fastest
    pbs.k_stretch = [0.1, 0.2, 0.5]
    pbs.iterations = [6, 24]
    [[run]]                             # or, or besides, one by one
    deformers.use = ["lbs", "pbs"]
    [output]
    rows = "deformers"                  # of sweep.csv: one a run and deformer (default), or "frames": one a frame as well
    batch = 1                           # runs a job

A run's name is the hash of its scene, its keys and the files that these name: a sweep that grows keeps the runs that it has."""
import dataclasses
import hashlib
import itertools
import json
import math
import pathlib
import re
import tomllib

import scene_files

MOST_RUNS = 1_000_000
KEY = re.compile(r"[A-Za-z_]\w*(\.\w+)+")


class SweepError(Exception):
    """FILE:LINE: FIELD = VALUE: RULE"""

    def __init__(self, file, line, field, value, rule):
        place = f"{file}:{line}" if line else str(file)
        super().__init__(f"{place}: " + (f"{field} = {value}: " if field else "") + rule)


@dataclasses.dataclass(frozen=True)
class Run:
    name: str        # of its folder
    varied: dict     # key -> value as TOML: what tells it from the others
    overrides: list  # key=value, all of --set


@dataclasses.dataclass(frozen=True)
class Sweep:
    file: pathlib.Path
    text: str
    scene: str       # as pbskin takes it
    scene_hash: str  # of a scene file; of a built-in scene its name
    rows: str
    batch: int
    files: dict      # that the scene or the runs name -> hash
    keys: list       # those that vary
    runs: list

    def batches(self):
        """Name -> runs of one job, in the sweep's order; as a run's, the name is of what is in it."""
        parts = (self.runs[i:i + self.batch] for i in range(0, len(self.runs), self.batch))
        return {part[0].name if len(part) == 1 else short_hash([run.name for run in part]): part for part in parts}


def short_hash(value):
    return hashlib.sha256(json.dumps(value).encode()).hexdigest()[:16]


def toml_of(value):
    """A value as --set reads it, or nothing for one that no scene has."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) or isinstance(value, float) and math.isfinite(value):
        return repr(value)
    if isinstance(value, str) and value.isprintable():
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        parts = [toml_of(part) for part in value]
        return None if None in parts else "[" + ", ".join(parts) + "]"
    return None


class _Reader:
    def __init__(self, file):
        self.file = pathlib.Path(file)
        try:
            self.text = self.file.read_text(encoding="utf-8")
            self.document = tomllib.loads(self.text)
        except OSError as error:
            raise SweepError(file, 0, "", "", error.strerror) from None
        except UnicodeDecodeError:
            raise SweepError(file, 0, "", "", "expected UTF-8 text") from None
        except tomllib.TOMLDecodeError as error:
            place = re.search(r"\(at (?:line (\d+), column \d+|end of document)\)", str(error))
            line = place and place[1] or self.text.count("\n") + 1
            raise SweepError(file, line, "", "", f"no TOML: {error}") from None

    def line_of(self, table, key, occurrence=0):
        """Of a key in the table, or of the table; 1 where it cannot be found."""
        current, found, seen = "", 1, -1
        for number, line in enumerate(self.text.splitlines(), 1):
            header = re.match(r"\s*\[+\s*([\w.]+)\s*\]", line)
            if header:
                seen += header[1] == table
                current = header[1]
            name = re.match(r"""\s*([\w.\s"'-]+?)\s*=""", line)
            path = ".".join(part for part in (current, re.sub(r"[\s\"']", "", name[1]) if name else "") if part)
            if table and seen != occurrence or not (path + ".").startswith(table + "." if table else ""):
                continue
            if path == ".".join(part for part in (table, key) if part):
                return number
            found = number if header and header[1] == table else found
        return found

    def refuse(self, table, key, value, rule, occurrence=0):
        field = ".".join(part for part in (table, key) if part)
        shown = toml_of(value) or str(value)
        raise SweepError(self.file, self.line_of(table, key, occurrence), field, shown[:80], rule)

    def only(self, table, content, known):
        if not isinstance(content, dict):
            self.refuse("", table, content, "expected a table")
        for key, value in content.items():
            if key not in known:
                self.refuse(table, key, value, "unknown key; expected one of " + ", ".join(known))

    def flat(self, table, content, occurrence=0):
        """Scene keys `table.key` of a table, dotted as they may be."""
        if not isinstance(content, dict):
            self.refuse("", table, content, "expected a table")
        entries = {}

        def walk(prefix, value):
            if isinstance(value, dict):
                for key, part in value.items():
                    walk(f"{prefix}.{key}" if prefix else key, part)
                return
            if not KEY.fullmatch(prefix):
                self.refuse(table, prefix, value, "expected a key of the scene, as pbs.iterations", occurrence)
            if toml_of(value) is None:
                self.refuse(table, prefix, value, "expected a finite number, a text, true, false, or a list of these", occurrence)
            entries[prefix] = value

        walk("", content)
        return entries

    def grid(self):
        grid = self.flat("grid", self.document.get("grid", {}))
        for key, values in grid.items():
            if not isinstance(values, list) or not values:
                self.refuse("grid", key, values, "expected a list of at least one value")
            texts = [toml_of(value) for value in values]
            if len(set(texts)) != len(texts):
                self.refuse("grid", key, values, "expected every value once")
        return grid

    def listed(self, taken):
        tables = self.document.get("run", [])
        if not isinstance(tables, list):
            self.refuse("", "run", tables, "expected [[run]] tables")
        rows = [self.flat("run", table, i) for i, table in enumerate(tables)]
        for i, row in enumerate(rows):
            for key, value in row.items():
                if key in taken:
                    self.refuse("run", key, value, "is set for all runs", i)
            if set(row) != set(rows[0]) or not row:
                self.refuse("run", "", ", ".join(row), "expected the keys of the first [[run]]: " + ", ".join(rows[0]), i)
            if row in rows[:i]:
                self.refuse("run", "", row, "expected every run once", i)
        return rows

    def output(self):
        output = self.document.get("output", {})
        self.only("output", output, ["rows", "batch"])
        rows, batch = output.get("rows", "deformers"), output.get("batch", 1)
        if rows not in ("deformers", "frames"):
            self.refuse("output", "rows", rows, "expected deformers or frames")
        if type(batch) is not int or not 1 <= batch <= MOST_RUNS:
            self.refuse("output", "batch", batch, "expected a whole number of at least 1")
        return rows, batch

    def scene(self):
        """As pbskin takes it, and what stands for it in a run's hash."""
        scene = self.document.get("scene")
        if not isinstance(scene, str) or not scene:
            self.refuse("", "scene", scene, "expected a scene: a built-in one's name (pbskin list), or a file")
        if not scene.endswith(".toml"):
            return scene, scene
        path = (self.file.parent / scene).resolve()
        try:
            return str(path), hashlib.sha256(path.read_bytes()).hexdigest()
        except OSError as error:
            return self.refuse("", "scene", scene, error.strerror)


def _expand(reader, scene, scene_hash):
    """The runs, and the files that scene and runs name with their hashes."""
    fixed = reader.flat("set", reader.document.get("set", {}))
    grid = reader.grid()
    for key in set(grid) & set(fixed):
        reader.refuse("grid", key, grid[key], "is set for all runs")
    listed = reader.listed({**fixed, **grid})
    if not grid and not listed:
        reader.refuse("", "grid", "", "expected a [grid] or [[run]] tables: nothing varies")
    count = math.prod(map(len, grid.values())) * max(len(listed), 1)
    if count > MOST_RUNS:
        reader.refuse("grid", "", f"{count} runs", f"expected at most {MOST_RUNS}")
    folder, runs = pathlib.Path(scene).parent if scene.endswith(".toml") else None, []
    of_all = scene_files.files_of([scene_files.scene_values(scene) if folder else {}, fixed], folder)
    files = dict(of_all)
    for row in listed or [{}]:
        for values in itertools.product(*grid.values()):
            own = {**row, **dict(zip(grid, values))}
            named = of_all | scene_files.files_of(own, folder)
            files |= named
            varied = {key: toml_of(value) for key, value in own.items()}
            every = {key: toml_of(value) for key, value in fixed.items()} | varied
            identity = [scene_hash, sorted(every.items()), *([sorted(named.items())] if named else [])]
            runs.append(Run(short_hash(identity), varied, [f"{key}={value}" for key, value in every.items()]))
    return runs, files


def read(file):
    """The sweep that a file describes, or a SweepError."""
    reader = _Reader(file)
    reader.only("", reader.document, ["schema", "scene", "set", "grid", "run", "output"])
    if reader.document.get("schema") != 1 or reader.document["schema"] is True:
        reader.refuse("", "schema", reader.document.get("schema"), "expected 1")
    scene, scene_hash = reader.scene()
    rows, batch = reader.output()
    try:
        runs, files = _expand(reader, scene, scene_hash)
    except OSError as error:
        raise SweepError(error.filename, 0, "", "", f"{error.strerror}; named by {reader.file} or its scene") from None
    return Sweep(reader.file, reader.text, scene, scene_hash, rows, batch, files, list(runs[0].varied), runs)
