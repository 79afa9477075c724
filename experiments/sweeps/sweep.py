#!/usr/bin/python3 -B
"""Many runs by Snakemake, on this machine or on a Slurm cluster: of one scene, with one table of all of them, or of the
record.

    sweep.py check SWEEP.toml                         lists the runs
    sweep.py run SWEEP.toml -o DIR -j 2               DIR/sweep.csv, costs.csv, sweep.json, runs/NAME/
    sweep.py run SWEEP.toml -o DIR --slurm            the same as Slurm jobs, by the profile slurm next to this script
    sweep.py reproduce C02 --full -o DIR --slurm      what `pbskin reproduce C02 --full -o DIR` writes and prints

Both continue where they were stopped. Further arguments go to snakemake, whose exit status is returned if a run failed
(2: bad input). README.md describes the sweep file. An installation has this script as `pbskin-sweep`."""
import argparse
import fcntl
import hashlib
import itertools
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import merge

HERE = pathlib.Path(__file__).resolve().parent
KEY = re.compile(r"[A-Za-z_]\w*(\.\w+)+")
WHOLE_MACHINE = 1000  # more than runs at once


class SweepError(Exception):
    """FILE:LINE: FIELD = VALUE: RULE"""


class Sweep:
    """A sweep file. scene: as pbskin takes it. rows: deformers or frames. batch: runs per Slurm job. runs: name ->
    {key: value as TOML}, of the keys that vary. The name is the hash of scene and keys, so that a sweep that grows
    keeps the runs that it has. files: that scene or keys name. written: by each run."""
    written = ["runs/{name}/run.json", "runs/{name}/metrics.csv"]

    def __init__(self, file):
        self.file = pathlib.Path(file)
        try:
            self.text = self.file.read_text(encoding="utf-8")
            document = tomllib.loads(self.text)
        except (OSError, ValueError) as error:
            raise SweepError(f"{file}: {error}") from None
        for key in document:
            if key not in ("schema", "scene", "set", "grid", "run", "output"):
                self.refuse(key, document[key], "unknown key; expected one of schema, scene, set, grid, run, output")
        if document.get("schema") != 1:
            self.refuse("schema", document.get("schema"), "expected 1")
        self.scene = document.get("scene")
        if not isinstance(self.scene, str) or not self.scene:
            self.refuse("scene", self.scene, "expected the name of a built-in scene (pbskin list scenes), "
                                             "or a scene file")
        if self.scene.endswith(".toml"):
            self.scene = str((self.file.parent / self.scene).resolve())
            if not os.path.isfile(self.scene):
                self.refuse("scene", self.scene, "no such file")
        for table, kind in (("set", dict), ("grid", dict), ("run", list), ("output", dict)):
            if not isinstance(document.get(table, kind()), kind):
                self.refuse(table, document[table], "expected [[run]] tables" if kind is list else "expected a table")
        output = document.get("output", {})
        self.rows = output.get("rows", "deformers")
        self.batch = output.get("batch", 1)
        if self.rows not in ("deformers", "frames") or set(output) - {"rows", "batch"}:
            self.refuse("output", output, "expected rows = \"deformers\" or \"frames\", and batch = a number of runs")
        if type(self.batch) is not int or self.batch < 1:
            self.refuse("output.batch", self.batch, "expected a whole number of at least 1")
        self.fixed = self.flat("set", document.get("set", {}))
        self.runs = self.expanded(self.flat("grid", document.get("grid", {})),
                                  [self.flat("run", row) for row in document.get("run", [])])
        keys = " ".join(value for entries in (self.fixed, *self.runs.values()) for value in entries.values())
        folder = pathlib.Path(self.scene).parent
        self.files = sorted(named_files(json.dumps(self.scene) if self.scene.endswith(".toml") else "", folder)
                            | named_files(keys, folder))

    def refuse(self, field, value, rule):
        name = re.escape(field.split(".")[-1])
        key = re.compile(rf"\s*\[*\s*([\w.]+\.)?{name}\b")
        line = next((number for number, text in enumerate(self.text.splitlines(), 1) if key.match(text)), 1)
        raise SweepError(f"{self.file}:{line}: {field} = {str(value)[:80]}: {rule}")

    def flat(self, table, content):
        """Keys of the scene with their values, whichever way they are nested."""
        entries = {}

        def walk(prefix, value):
            if isinstance(value, dict):
                for key, part in value.items():
                    walk(f"{prefix}.{key}" if prefix else key, part)
                return
            if not KEY.fullmatch(prefix):
                self.refuse(f"{table}.{prefix}", value, "expected a key of the scene, such as pbs.iterations")
            if table == "grid" and (not isinstance(value, list) or not value
                                    or any(value.count(one) > 1 for one in value)):
                self.refuse(f"grid.{prefix}", value, "expected a list of different values")
            if toml_of(value) is None:
                self.refuse(f"{table}.{prefix}", value, "expected a finite number, a text, true, false, "
                                                        "or a list of these")
            entries[prefix] = value if table == "grid" else toml_of(value)

        walk("", content)
        return entries

    def expanded(self, grid, rows):
        taken = [*self.fixed, *grid, *(rows[0] if rows else [])]
        for key in taken:
            if taken.count(key) > 1:
                self.refuse(key, grid.get(key, self.fixed.get(key)),
                            "expected in one of [set], [grid] and [[run]] only")
        if not grid and not rows:
            self.refuse("grid", "", "expected a [grid] or [[run]] tables: nothing varies")
        runs = {}
        for row in rows or [{}]:
            if rows and row.keys() != rows[0].keys():
                self.refuse("run", ", ".join(row), "expected the keys of the first [[run]]: " + ", ".join(rows[0]))
            for values in itertools.product(*grid.values()):
                keys = row | {key: toml_of(value) for key, value in zip(grid, values)}
                name = hashlib.sha256(json.dumps([self.scene,
                                                  sorted((self.fixed | keys).items())]).encode()).hexdigest()[:16]
                if name in runs:
                    self.refuse("run", row, "expected every run once")
                runs[name] = keys
        return runs

    def arguments(self, name):
        """Of pbskin, in the folder of the results."""
        values = self.fixed | self.runs[name]
        overrides = [part for key, value in values.items() for part in ("--set", f"{key}={value}")]
        return ["run", self.scene, "--quiet", "-o", f"runs/{name}", *overrides]

    def measures_time(self, name):
        return False

    def conclude(self, pbskin):
        merge.write(self, pathlib.Path())


class Record:
    """The runs to do of `pbskin reproduce`, as planned() writes them, with the interface of Sweep. The program itself
    knows which runs are finished."""
    written, files, batch = ["{name}/run.json"], [], 1

    def __init__(self, file):
        self.begun_in, self.verb, runs = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
        self.runs = {run["run"]: run for run in runs}

    def arguments(self, name):
        return ["reproduce", *self.runs[name]["arguments"], "-o", "."]

    def measures_time(self, name):
        return self.runs[name]["alone"]

    def conclude(self, pbskin):
        """Becomes pbskin, which writes the tables, prints the last screen, and ends with its own exit status."""
        os.chdir(self.begun_in)
        os.execv(pbskin, [pbskin, *self.verb])


def planned(options, is_dry):
    """Writes the runs to do of `reproduce` to a file, and removes their records of another revision or settings."""
    verb = ["reproduce", *options.input, *["--full"] * options.full, "--resume", "-o", str(options.output)]
    process = subprocess.run([options.pbskin, *verb, "--plan"], stdout=subprocess.PIPE, check=False)
    if process.returncode:
        sys.exit(process.returncode)
    runs = json.loads(process.stdout)
    file = options.output / "workflow.json"
    file.write_text(json.dumps([os.getcwd(), verb, runs], indent=1) + "\n", encoding="utf-8")
    for run in [] if is_dry else runs:
        (options.output / run["run"] / "run.json").unlink(missing_ok=True)
    return file


def named_files(text, folder):
    """The files that quoted texts name, what these name in turn (a scene's mesh, a glTF's buffers), and companions
    (.node and .ele)."""
    found = set()
    for name in re.findall(r'"([^"\\\n]{1,250})"', text):
        path = folder / name
        if not path.suffix or not path.is_file():
            continue
        found |= {str(beside) for beside in path.parent.glob(f"{path.stem}.*")
                  if beside.suffix in (path.suffix, ".node", ".ele")}
        if path.suffix in (".toml", ".gltf"):
            found |= named_files(path.read_text(encoding="utf-8", errors="replace"), path.parent)
    return found


def toml_of(value):
    """A value as --set reads it, or nothing for one that no scene has."""
    if isinstance(value, list):
        parts = [toml_of(part) for part in value]
        return None if None in parts else "[" + ", ".join(parts) + "]"
    if isinstance(value, float) and not math.isfinite(value) or not isinstance(value, (bool, int, float, str)):
        return None
    return json.dumps(value, ensure_ascii=False)


def read(file):
    return (Record if str(file).endswith(".json") else Sweep)(file)


def program():
    """The pbskin next to an installation PREFIX/share/pbskin/sweeps, the one built in a checkout, or the one on the
    PATH."""
    place = (HERE.parents[2] / "bin/pbskin" if HERE.parent.name == "pbskin"
             else HERE.parents[1] / "build/release/bin/pbskin")
    return str(place) if place.is_file() else shutil.which("pbskin") or str(place)


def run(options, more):
    if not shutil.which("snakemake"):
        raise SweepError("snakemake is not installed")
    if not os.access(options.pbskin, os.X_OK):
        raise SweepError(f"{options.pbskin}: no such program")
    os.makedirs(options.output, exist_ok=True)
    lock = os.open(options.output / ".lock", os.O_CREAT | os.O_RDWR)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise SweepError(f"{options.output}: another sweep runs there") from None
    if options.verb == "run":
        file = options.input[0]
    else:
        file = planned(options, {"-n", "--dry-run", "--dryrun"} & set(more))
        more = ["--forceall", *more]  # all runs of the plan are to do
    os.set_inheritable(lock, True)  # unlike snakemake's own lock, this one ends with snakemake, however it ends
    slurm = ["--profile", str(HERE / "slurm"), "--group-components", f"runs={read(file).batch}"]
    here = ["--cores", str(options.jobs), "--resources", f"machine={WHOLE_MACHINE}", "--quiet", "rules",
            "--scheduler", "greedy"]
    os.execvp("snakemake", ["snakemake", "-s", str(HERE / "Snakefile"), "-d", str(options.output), "--nolock",
                            "--rerun-incomplete", "--rerun-triggers", "mtime", "params", "input",
                            *(slurm if options.slurm else here), *more, "--config", f"sweep={os.path.abspath(file)}",
                            f"pbskin={os.path.abspath(options.pbskin)}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("verb", choices=["check", "run", "reproduce"])
    parser.add_argument("input", nargs="*", help="a sweep; of reproduce: claims or studies, by default its own choice")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="by default results/sweep or results/reproduce")
    parser.add_argument("-j", "--jobs", type=int, default=1, help="runs at once; on Slurm the profile states it")
    parser.add_argument("--full", action="store_true", help="of reproduce")
    parser.add_argument("--slurm", action="store_true")
    parser.add_argument("--pbskin", default=program())
    options, more = parser.parse_known_intermixed_args()
    if options.verb != "reproduce" and len(options.input) != 1:
        parser.error("expected one sweep file")
    options.output = options.output or pathlib.Path("results", "reproduce" if options.verb == "reproduce" else "sweep")
    try:
        plan = Sweep(options.input[0]) if options.verb != "reproduce" else None
        if options.verb != "check":
            run(options, [option for option in more if option != "--"])
        for name, keys in plan.runs.items():
            print(name, *(f"{key}={value}" for key, value in keys.items()))
        print(f"{len(plan.runs)} runs")
    except (SweepError, OSError) as error:
        print(f"sweep: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
