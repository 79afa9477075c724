"""The runs of one job, one after the other, each in its own folder `runs/NAME` with `pbskin run`'s records.

A run that is finished has an outcome.json beside them, written last: how it ended (0, or 3: a numerical breakdown, which is a result), and
what it cost. It is never run again. Bad input (2), an interruption or a crash is no outcome: it stops the job with the program's message,
which also lies in `refused/NAME.txt`."""
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import time

OUTCOMES = (0, 3)


class RunFailed(Exception):
    def __init__(self, status, message):
        super().__init__(message)
        self.status = status


def write_atomically(path, text):
    """Beside and renamed: a reader finds the whole file or none."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=f".{path.name}.", delete=False, newline="", encoding="utf-8") as file:
        try:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        except BaseException:
            os.unlink(file.name)
            raise
    os.chmod(file.name, 0o644)
    os.replace(file.name, path)


def children_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def stored(folder):
    """Files, and bytes as the disk counts them, in whole blocks."""
    found = [path.lstat() for path in pathlib.Path(folder).rglob("*")]
    return len(found) + 1, sum(entry.st_blocks * 512 for entry in found)


def finish(sweep, run, folder, pbskin):
    """The run's outcome, of before or of now."""
    place = pathlib.Path(folder, "runs", run.name)
    record, refused = place / "outcome.json", pathlib.Path(folder, "refused", run.name + ".txt")
    if record.exists():
        return json.loads(record.read_text())
    command = [str(pbskin), "run", sweep.scene, "--quiet", "-o", str(place)]
    for override in run.overrides:
        command += ["--set", override]
    start, before = time.monotonic(), children_seconds()
    process = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
    seconds, cpu_seconds = time.monotonic() - start, children_seconds() - before
    if process.returncode not in OUTCOMES:
        told = process.stderr.strip() or f"{pbskin} ended with status {process.returncode}"
        write_atomically(refused, told + "\n")
        raise RunFailed(process.returncode, told)
    files, size = stored(place)
    outcome = {"schema": 1, "exit_status": process.returncode, "message": process.stderr.strip(), "seconds": round(seconds, 3),
               "cpu_seconds": round(cpu_seconds, 3), "files": files + 1, "stored_bytes": size + 4096}
    write_atomically(record, json.dumps(outcome, indent=2, sort_keys=True) + "\n")
    refused.unlink(missing_ok=True)
    return outcome


def finish_batch(sweep, name, folder, pbskin):
    """All runs of a job, and its mark."""
    runs = sweep.batches()[name]
    outcomes = {run.name: finish(sweep, run, folder, pbskin)["exit_status"] for run in runs}
    write_atomically(pathlib.Path(folder, "batches", name + ".json"), json.dumps(outcomes, indent=2) + "\n")
