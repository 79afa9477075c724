"""The runs of one job, one after the other, each in its own folder `runs/NAME` with `pbskin run`'s records.

A run's folder is there when the run is finished, with an outcome.json: how it ended (0, or 3: a numerical breakdown, which is a result),
and what it cost. It is never run again. Bad input (2), an interruption or a crash is no outcome: it stops the job with the program's
message, which also lies in `failed/NAME.json`."""
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import time

from atomic_text import write_atomically

OUTCOMES = (0, 3)


class RunFailed(Exception):
    def __init__(self, status, message):
        super().__init__(message)
        self.status = status


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def stored(folder):
    """Files, and bytes as the disk counts them, in whole blocks."""
    found = [path.lstat() for path in pathlib.Path(folder).rglob("*")]
    return len(found) + 1, sum(entry.st_blocks * 512 for entry in found)


def outcome_of(place):
    try:
        return json.loads((place / "outcome.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except ValueError as error:
        raise RunFailed(1, f"{place}: {error}; remove the folder and run the sweep again") from None


def finish(sweep, run, folder, pbskin):
    """The run's outcome, of before or of now. It runs beside and its folder is renamed: of two jobs that do the same run, as where a killed
    sweep's jobs are still queued, the first to end counts."""
    place, failed = pathlib.Path(folder, "runs", run.name), pathlib.Path(folder, "failed", run.name + ".json")
    outcome = outcome_of(place)
    if outcome:
        return outcome
    place.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=place.parent, prefix=f".{run.name}.", ignore_cleanup_errors=True) as own:
        made = pathlib.Path(own, "run")
        try:
            outcome = start(sweep, run, made, pbskin)
        except RunFailed as error:
            write_atomically(failed, json.dumps({"status": error.status, "message": str(error)}) + "\n")
            raise
        try:
            os.rename(made, place)
        except OSError:
            outcome = outcome_of(place)
    if not outcome:
        raise RunFailed(1, f"{place}: not a finished run, in the way of one; remove the folder and run the sweep again")
    failed.unlink(missing_ok=True)
    return outcome


def start(sweep, run, place, pbskin):
    """One `pbskin run` into a new folder, its outcome.json last."""
    command = [str(pbskin), "run", sweep.scene, "--quiet", "-o", str(place)]
    for override in run.overrides:
        command += ["--set", override]
    begin, before = time.monotonic(), children_seconds()
    try:
        process = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                 errors="replace")
    except OSError as error:
        raise RunFailed(127, f"{pbskin}: {error.strerror}") from None
    seconds, cpu_seconds = time.monotonic() - begin, children_seconds() - before
    if process.returncode not in OUTCOMES:
        raise RunFailed(process.returncode, process.stderr.strip() or f"{pbskin} ended with status {process.returncode}")
    files, size = stored(place)
    outcome = {"schema": 1, "exit_status": process.returncode, "message": process.stderr.strip(), "seconds": round(seconds, 3),
               "cpu_seconds": round(cpu_seconds, 3), "files": files + 1, "stored_bytes": size + 4096}
    write_atomically(place / "outcome.json", json.dumps(outcome, indent=2, sort_keys=True) + "\n")
    return outcome


def finish_batch(sweep, name, folder, pbskin):
    """All runs of a job, and its mark."""
    runs = sweep.batches().get(name)
    if not runs:
        raise RunFailed(1, f"sweep: {sweep.file}: no job {name}: the sweep, or a file that it names, has changed; run the sweep again")
    outcomes = {run.name: finish(sweep, run, folder, pbskin)["exit_status"] for run in runs}
    write_atomically(pathlib.Path(folder, "batches", name + ".json"), json.dumps(outcomes, indent=2) + "\n")
