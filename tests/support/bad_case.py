"""One bad input through the real program: exit status, what stderr names, time, memory, and that nothing is left behind."""
import dataclasses
import os
import pathlib
import resource
import subprocess
import tempfile
import threading

PBSKIN = os.environ["PBSKIN"]
MOST_SECONDS, MOST_BYTES = 5.0, 1 << 30  # of processor time: other work on the machine must not fail a case
MOST_WAITING_SECONDS = 25.0  # then it hangs
NOBODY = {"user": 65534, "group": 65534, "extra_groups": []}


@dataclasses.dataclass
class Case:
    """`files` (name -> text, bytes, or a function that makes it from its path) beside `command`'s arguments; stderr must hold `says`."""
    name: str
    files: dict
    command: list
    says: tuple
    status: int = 2
    leaves: tuple = ()  # what names may begin with that are there afterwards
    as_nobody: bool = False  # where root runs the tests, whom no mode stops


def make(folder, files):
    for name, content in files.items():
        path = folder / name
        if callable(content):
            content(path)
        elif isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content, encoding="utf-8")


def listing(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def someone_else(case):
    return NOBODY if case.as_nobody and os.geteuid() == 0 else {}


def nobody_can_run_it():
    try:
        return os.geteuid() != 0 or subprocess.run([PBSKIN, "--version"], capture_output=True, cwd="/", **NOBODY).returncode == 0
    except PermissionError:
        return False


def problems(case, common):
    """What is wrong with the answer to `case`; empty where all is well. `common` files are there in every case."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        folder.chmod(0o755)
        make(folder, common | case.files)
        before, found = listing(folder), []
        errors = folder.parent / (folder.name + ".errors")
        with open(errors, "wb") as file:
            process = subprocess.Popen([PBSKIN, *case.command], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=file,
                                       env={**os.environ, "PBSKIN_CACHE": temporary + "/cache", "NO_COLOR": "1"}, **someone_else(case))
            stop = threading.Timer(MOST_WAITING_SECONDS, process.kill)
            stop.start()
            _, status, used = os.wait4(process.pid, 0)
            stop.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        told = errors.read_text(encoding="utf-8", errors="replace")
        errors.unlink()
        if process.returncode != case.status:
            found.append(f"exit status {process.returncode}, expected {case.status}")
        ours = [line.startswith("pbskin: ") for line in told.splitlines()]
        if case.status == 2 and (sum(ours) != 1 or not ours[-1]):
            found.append("expected one line that begins with `pbskin: `, and that the last")
        found += [f"does not say {word!r}" for word in case.says if word not in told]
        if used.ru_utime + used.ru_stime > MOST_SECONDS:
            found.append(f"took {used.ru_utime + used.ru_stime:.1f} s of processor time")
        if used.ru_maxrss * 1024 > MOST_BYTES:
            found.append(f"took {used.ru_maxrss >> 10} MB")
        left = {name for name in listing(folder) - before if not name.startswith(("cache", *case.leaves))}
        if left:
            found.append(f"left behind: {sorted(left)[:5]}")
        return [f"{case.name}: {problem}\n    {told.strip()[:300]}" for problem in found]


def limit_address_space():
    """For this process and all it starts, so that a run gone wild cannot take the machine along."""
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
