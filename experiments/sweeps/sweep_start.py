"""Starts snakemake over a sweep's folder, which is made fit for it, and ends it when told to end."""
import contextlib
import ctypes
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
INTERRUPTED = 130  # as pbskin's
DEATH_SIGNAL = 1
_prctl = ctypes.CDLL(None).prctl


class StartError(Exception):
    """Bad usage, or a machine that is not ready."""


def ready(options):
    if options.jobs < 1:
        raise StartError(f"--jobs = {options.jobs}: expected at least 1")
    if not options.pbskin.is_file():
        raise StartError(f"{options.pbskin}: no such program")
    if not shutil.which("snakemake"):
        raise StartError("snakemake is not installed")


def locked(folder):
    """A descriptor that holds the folder; unlike snakemake's own lock, it ends with who holds it."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock = os.open(folder / ".lock", os.O_CREAT | os.O_RDWR)
    except OSError as error:
        raise StartError(f"{folder}: {error.strerror}: expected a folder to write to") from None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise StartError(f"{folder}: another sweep runs there") from None
    return lock


def forget_lost_runs(folder):
    """A job's mark outlives the folder of a run that somebody removed; without it the job runs again, and the tables are made again."""
    for mark in folder.glob("batches/*.json"):
        if not all((folder / "runs" / name / "outcome.json").is_file() for name in json.loads(mark.read_text(encoding="utf-8"))):
            mark.unlink()
            (folder / "sweep.json").unlink(missing_ok=True)


def revision_of_program(pbskin):
    """(git revision, dirty), or nothing if the program does not state it."""
    process = subprocess.run([pbskin, "--version", "--json"], capture_output=True, text=True, errors="replace")
    with contextlib.suppress(ValueError, KeyError, TypeError):
        build = json.loads(process.stdout)
        return build["git_revision"], build["git_dirty"]
    return None


def runs_of_other_revisions(sweep, folder, pbskin):
    """Names of finished runs that another pbskin made."""
    now = revision_of_program(pbskin)
    names = []
    for run in sweep.runs if now else []:
        with contextlib.suppress(OSError, ValueError, KeyError):  # not finished, or the merge tells what is wrong
            build = json.loads((folder / "runs" / run.name / "run.json").read_text(encoding="utf-8"))["provenance"]
            if (build["git_revision"], build.get("git_dirty", False)) != now:
                names.append(run.name)
    return names


def command(options, more):
    if options.slurm:
        where = ["--profile", str(HERE / "slurm")]
    else:
        where = ["--cores", str(options.jobs), "--quiet", "rules", "--scheduler", "greedy"]
    return ["snakemake", "-s", str(HERE / "Snakefile"), "-d", str(options.output), "--nolock", "--rerun-incomplete", *where, *more,
            "--config", f"sweep={pathlib.Path(options.sweep).resolve()}", f"pbskin={options.pbskin.resolve()}"]


def until_ended(words, lock):
    """The status, of us when interrupted: the first SIGINT or SIGTERM interrupts snakemake and its jobs here, a second kills them. They are
    a process group of their own, so that a terminal's ^C comes once; snakemake also dies where we are killed."""
    process, caught = None, []

    def forward():
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT if len(caught) == 1 else signal.SIGKILL)

    def on_signal(number, _):
        caught.append(number)
        if process and process.returncode is None:
            forward()

    before = {number: signal.signal(number, on_signal) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        process = subprocess.Popen(words, pass_fds=[lock], process_group=0, preexec_fn=lambda: _prctl(DEATH_SIGNAL, signal.SIGKILL))
        if caught:
            forward()
        status = process.wait()
        with contextlib.suppress(ProcessLookupError):
            if caught:
                os.killpg(process.pid, signal.SIGKILL)  # jobs that it left
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    return INTERRUPTED if caught else status


def cancel_jobs(folder):
    """Slurm jobs of this folder that are left in the queue: snakemake cancels those that it knows of, but not those that it just asks
    about."""
    queued = subprocess.run(["squeue", "--me", "-h", "-o", "%i %Z"], capture_output=True, text=True).stdout.splitlines()
    jobs = [job for job, place in (line.split(" ", 1) for line in queued) if pathlib.Path(place) == folder.resolve()]
    if jobs:
        subprocess.run(["scancel", *jobs], capture_output=True)


def run(sweep, options, more):
    """0 finished, 1 failed, 2 where a run was refused, whose message is shown again, 130 interrupted."""
    ready(options)
    lock = locked(options.output)
    for old in options.output.glob("failed/*.json"):
        old.unlink()
    forget_lost_runs(options.output)
    others = runs_of_other_revisions(sweep, options.output, options.pbskin)
    if others:
        print(f"sweep: {len(others)} of {len(sweep.runs)} runs are there from another revision of pbskin, as runs/{others[0]}, and are "
              "kept; remove them, or give another -o, to run them again", file=sys.stderr)
    status = until_ended(command(options, more), lock)
    if status == INTERRUPTED:
        if options.slurm and shutil.which("squeue"):
            cancel_jobs(options.output)
        print("sweep: interrupted; what is finished is kept, and the same command goes on", file=sys.stderr)
        return status
    failed = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(options.output.glob("failed/*.json"))}
    for name, told in list(failed.items())[:10]:
        print(f"sweep: run {name}: {told['message']}", file=sys.stderr)
    if status == 0:
        print(f"{len(sweep.runs)} runs: {options.output / 'sweep.csv'}")
    return 2 if any(told["status"] == 2 for told in failed.values()) else 1 if status else 0
