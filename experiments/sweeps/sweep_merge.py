"""One table of all runs, in the order of the sweep whatever order they ended in:

sweep.csv    a row a run and deformer (or a frame as well): the keys that vary, the outcome, mean, least and largest of every metric over
             the frames, units in the metrics' names, and the state's hash. No times: the same runs make the same bytes, on any machine
             of one kind.
costs.csv    a row a run: seconds, processor seconds, memory, files and bytes.
sweep.json   where all of it comes from; written last.

Every file is written beside and renamed, by one process, after all runs have ended."""
import csv
import hashlib
import json
import math
import os
import pathlib
import shutil

from atomic_text import atomic_text, write_atomically

IDENTITY = ["scene", "deformer", "variant", "order", "precision", "iterations", "threads", "frame", "time_s", "outcome"]
TIMES = ["step_ms"]
BROKEN = {"frames_not_finite": "breakdowns", "frames_not_converged": "not_converged", "frames_broken": "broken_frames"}


class MergeError(Exception):
    pass


def read_run(folder, name):
    """Outcome, record, and rows of metrics.csv."""
    place = pathlib.Path(folder, "runs", name)
    try:
        outcome = json.loads((place / "outcome.json").read_text(encoding="utf-8"))
        record = json.loads((place / "run.json").read_text(encoding="utf-8"))
        with open(place / "metrics.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file, strict=True))
    except (OSError, ValueError, csv.Error) as error:
        raise MergeError(f"{place}: no finished run: {error}; remove the folder and run the sweep again") from None
    if not rows or any(None in row or None in row.values() for row in rows):
        raise MergeError(f"{place / 'metrics.csv'}: no rows, or rows cut short; remove the folder and run the sweep again")
    return outcome, record, rows


def summary(values):
    """Mean, least and largest of the finite ones; empty where there is none. fsum rounds once, so the order does not matter."""
    numbers = [number for number in (float(value) for value in values if value) if math.isfinite(number)]
    if not numbers:
        return ["", "", ""]
    return [repr(math.fsum(numbers) / len(numbers)), repr(min(numbers)), repr(max(numbers))]


def metrics_of(row):
    return [column for column in row if column not in IDENTITY + TIMES]


class Table:
    """Rows of one kind, streamed: ten thousand runs with every frame need no memory."""

    def __init__(self, sweep, metrics, file):
        self.sweep, self.metrics = sweep, metrics
        self.writer = csv.writer(file, lineterminator="\n")
        head = ["run", *sweep.keys, "deformer", "exit_status"]
        self.writer.writerow(head + (self.frame_head() if sweep.rows == "frames" else self.summary_head()))

    def frame_head(self):
        return ["frame", "time_s", "outcome", *self.metrics]

    def summary_head(self):
        return ["frames", *BROKEN, "state_hash",
                *(f"{kind}_{metric}" for metric in self.metrics for kind in ("mean", "least", "largest"))]

    def add(self, run, outcome, record, rows):
        missing = [metric for metric in metrics_of(rows[0]) if metric not in self.metrics]
        if missing:
            raise MergeError(f"runs/{run.name}: has a metric that the first run has not: {missing[0]}; output.metrics must not vary")
        for deformer in record["scene"]["runs"]:
            label = deformer["label"]
            own = [row for row in rows if (row["deformer"], row["variant"]) == (deformer["name"], deformer["variant"])]
            head = [run.name, *(json_text(value) for value in run.varied.values()), label, outcome["exit_status"]]
            if self.sweep.rows == "frames":
                self.writer.writerows(head + [row.get(column, "") for column in self.frame_head()] for row in own)
            else:
                self.writer.writerow(head + self.summary_of(label, record, own))

    def summary_of(self, label, record, rows):
        counts = [len(record["outcome"].get(kind, {}).get(label, [])) for kind in BROKEN.values()]
        summaries = (summary(row.get(metric, "") for row in rows) for metric in self.metrics)
        return [len(rows), *counts, record["state_hash"][label], *(text for three in summaries for text in three)]


def json_text(value):
    """A TOML text without its quotes, anything else as it stands."""
    return json.loads(value) if value.startswith('"') else value


class Provenance:
    """What the runs say of themselves, each different thing once."""

    def __init__(self):
        self.said = {}
        self.statuses = {}

    def add(self, outcome, record):
        for key, value in record["provenance"].items():
            texts = self.said.setdefault(key, set())
            texts.add(json.dumps(value, sort_keys=True))
        status = str(outcome["exit_status"])
        self.statuses[status] = self.statuses.get(status, 0) + 1

    def record(self, sweep, digest):
        return {"schema": 1, "sweep": sweep.file.name, "sweep_text": sweep.text,
                "sweep_sha256": hashlib.sha256(sweep.text.encode()).hexdigest(),
                "scene": os.path.basename(sweep.scene), "scene_sha256_or_name": sweep.scene_hash,
                "files_sha256": sweep.files,
                "runs": len(sweep.runs), "exit_statuses": self.statuses, "sweep_csv_sha256": digest,
                "provenance": {key: [json.loads(text) for text in sorted(texts)] for key, texts in sorted(self.said.items())}}


def merge(sweep, folder):
    """Writes the three files; a MergeError where a run is missing or broken. Returns what sweep.json says."""
    folder, provenance, costs = pathlib.Path(folder), Provenance(), []
    metrics = metrics_of(read_run(folder, sweep.runs[0].name)[2][0])
    with atomic_text(folder / "sweep.csv") as file:
        table = Table(sweep, metrics, file)
        for run in sweep.runs:
            outcome, record, rows = read_run(folder, run.name)
            table.add(run, outcome, record, rows)
            provenance.add(outcome, record)
            costs.append(cost_row(run, outcome, record))
    head = "run,exit_status,seconds,cpu_seconds,peak_memory_mb,files,stored_bytes\n"
    write_atomically(folder / "costs.csv", head + "".join(costs))
    with open(folder / "sweep.csv", "rb") as file:
        told = provenance.record(sweep, hashlib.file_digest(file, "sha256").hexdigest())
    write_atomically(folder / "sweep.json", json.dumps(told, indent=2) + "\n")
    for left in (folder / "runs").glob(".*"):  # of jobs that were killed
        shutil.rmtree(left, ignore_errors=True)
    return told


def cost_row(run, outcome, record):
    return "%s,%d,%s,%s,%s,%d,%d\n" % (run.name, outcome["exit_status"], outcome["seconds"], outcome["cpu_seconds"],
                                       record["cost"]["peak_memory_mb"], outcome["files"], outcome["stored_bytes"])
