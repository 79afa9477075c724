"""One table of all runs of a sweep, in its order, whatever order they ended in:

sweep.csv    a row per run and deformer: the keys that vary, the outcome, mean, least and largest of every metric over
             the frames, and the hash of the states; or a row per frame. It has no times: the same runs give the same
             bytes, on any machine of one kind.
costs.csv    a row per run: seconds, processor seconds, memory.
sweep.json   the sweep, its exit statuses and where the runs come from.
"""
import csv
import hashlib
import json
import math
import sys

IDENTITY = ["scene", "deformer", "variant", "order", "precision", "iterations", "threads", "frame", "time_s", "outcome",
            "step_ms"]
BROKEN = {"frames_not_finite": "breakdowns", "frames_not_converged": "not_converged", "frames_broken": "broken_frames"}


def summary(values):
    """Mean, least and largest of the finite ones; empty where there is none. fsum rounds once, so the order does not
    matter."""
    numbers = [number for number in (float(value) for value in values if value) if math.isfinite(number)]
    return [repr(math.fsum(numbers) / len(numbers)), repr(min(numbers)),
            repr(max(numbers))] if numbers else ["", "", ""]


def plain(value):
    """A TOML text without its quotes, anything else as it stands."""
    return json.loads(value) if value.startswith('"') else value


def write(plan, folder):
    keys = list(next(iter(plan.runs.values())))
    statuses, origins, metrics = {}, {}, None
    with open(folder / "sweep.csv", "w", newline="", encoding="utf-8") as file, \
            open(folder / "costs.csv", "w", newline="", encoding="utf-8") as costs_file:
        table, costs = csv.writer(file, lineterminator="\n"), csv.writer(costs_file, lineterminator="\n")
        costs.writerow(["run", "exit_status", "seconds", "cpu_seconds", "peak_memory_mb"])
        for name, values in plan.runs.items():
            record = json.loads((folder / "runs" / name / "run.json").read_text(encoding="utf-8"))
            with open(folder / "runs" / name / "metrics.csv", newline="", encoding="utf-8") as stream:
                rows = list(csv.DictReader(stream, strict=True))
            own_metrics = [column for column in rows[0] if column not in IDENTITY]
            if metrics is None:
                metrics = own_metrics
                of_frames = ["frame", "time_s", "outcome", *metrics]
                of_runs = ["frames", *BROKEN, "state_hash",
                           *(f"{of}_{metric}" for metric in metrics for of in ("mean", "least", "largest"))]
                table.writerow(["run", *keys, "deformer", "exit_status",
                                *(of_frames if plan.rows == "frames" else of_runs)])
            if set(own_metrics) - set(metrics):
                raise ValueError(f"runs/{name}: has a metric that the first run has not; output.metrics must not vary")
            status = 3 if record["outcome"]["breakdown"] else 0
            statuses[str(status)] = statuses.get(str(status), 0) + 1
            for key, value in record["provenance"].items():
                origins.setdefault(key, set()).add(json.dumps(value, sort_keys=True))
            cost = record["cost"]
            costs.writerow([name, status, cost["seconds"]["total"], cost["cpu_seconds"]["total"],
                            cost["peak_memory_mb"]])
            for deformer in record["scene"]["runs"]:
                label = deformer["label"]
                own = [row for row in rows
                       if (row["deformer"], row["variant"]) == (deformer["name"], deformer["variant"])]
                head = [name, *map(plain, values.values()), label, status]
                if plan.rows == "frames":
                    table.writerows(head + [row.get(column, "") for column in of_frames] for row in own)
                else:
                    counts = [len(record["outcome"].get(kind, {}).get(label, [])) for kind in BROKEN.values()]
                    table.writerow([*head, len(own), *counts, record["state_hash"][label],
                                    *(text for metric in metrics
                                      for text in summary(row.get(metric, "") for row in own))])
    if len(origins["git_revision"]) > 1:
        print("sweep: the runs are of several revisions, see sweep.json", file=sys.stderr)
    sweep = {"schema": 1, "sweep": plan.file.name, "sweep_text": plan.text, "scene": plan.scene, "files": plan.files,
             "runs": len(plan.runs), "exit_statuses": statuses,
             "sweep_csv_sha256": hashlib.sha256((folder / "sweep.csv").read_bytes()).hexdigest(),
             "provenance": {key: [json.loads(text) for text in sorted(texts)]
                            for key, texts in sorted(origins.items())}}
    (folder / "sweep.json").write_text(json.dumps(sweep, indent=2) + "\n", encoding="utf-8")
