"""Runs the program on one bad input and checks the exit status, the one line on stderr, time and memory, and that
nothing is left behind."""
import dataclasses
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import threading

import run_records

PBSKIN = os.environ["PBSKIN"]
# With sanitizers, everything is several times slower and larger, and terabytes of addresses are reserved.
SANITIZED = "PBS_SANITIZED" in os.environ
SLOWER = 10 if SANITIZED else 1
# cases whose reader fails in another way without a limit on memory
UNLIMITED = re.compile(r"huge|a_word_for_an_index")
# Processor time, since other work must not fail a case; memory of each process.
MOST_SECONDS, MOST_BYTES = 5.0 * SLOWER, SLOWER << 30
# The limits by the expected exit status; a process that takes longer counts as hanging.
MOST_WAITING_SECONDS = {2: 25.0 * SLOWER, 0: 240.0}
NOBODY = {"user": 65534, "group": 65534, "extra_groups": []}
WORDS = r"\b(?:missing\b|[A-Za-z]\w+ \S)"  # the least that a rule consists of
RULE = rf"(?![^:=]+ = [^:]*:? ?$)(?=.*?{WORDS}).+"  # a field and a value alone are not a rule
LINE = re.compile(rf"pbskin: (?:(?P<place>[^:=\n]+)(?::\d+){{0,2}}: )?(?:(?P<field>[^:=\n]+) = (?P<value>.*?): "
                  rf")?(?P<rule>{RULE})")
USAGE = re.compile(r"pbskin: .+; `pbskin --help` lists the verbs, `pbskin VERB --help` their options")
NO_NUMBER = r" = (-?(?:nan|inf))\b"
WORDS_OF_NO_USER = ("json.exception", "basic_string", "std::", "vector::", "filesystem error", "terminate called",
                    "Traceback")


@dataclasses.dataclass
class Case:
    """`files` (name -> text, bytes, or a function that makes it from its path) exist in the folder in which `command`
    runs. stderr must contain `says`: the place, if its name is not among the files or the command's words, and the rule
    that is broken. A word may be several texts with " | " between them, where the versions of a library differ."""
    name: str
    files: dict
    command: list
    says: tuple
    status: int = 2
    leaves: tuple = ()  # beginnings of the names that may exist afterwards
    as_nobody: bool = False  # for tests run by root, to whom file modes do not apply


def demands_a_rule(case):
    """Whether one of the words that stderr must contain is a rule, and not the name of a command or file, a line, a
    field, or a value."""
    names = {*case.files, *map(str, case.command)}
    behind = (re.sub(r"^[^=]* = [^:]*(: |$)", "", word) for word in case.says
              if not any(word in name for name in names))
    return any(re.search(WORDS, re.sub(r"\S+\.\w+:(\d+:)*", "", rule)) for rule in behind)


def make(folder, files):
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if callable(content):
            content(path)
        else:
            # The file keeps the line ends of the text.
            path.write_bytes(content if isinstance(content, bytes) else content.encode())


def listing(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*")}


def nobody_can_run_it():
    try:
        return os.geteuid() != 0 or subprocess.run([PBSKIN, "--version"], capture_output=True, cwd="/",
                                                   **NOBODY).returncode == 0
    except PermissionError:
        return False


def finished(case, folder):
    """(exit status, stderr, resource usage) of the program in `folder`; the program is killed if it hangs."""
    environment = {**os.environ, "PBSKIN_CACHE": f"{folder}/cache", "TMPDIR": f"{folder}/tmp", "NO_COLOR": "1"}
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen([PBSKIN, *case.command], cwd=folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=errors, env=environment,
                                   **(NOBODY if case.as_nobody and os.geteuid() == 0 else {}))
        stop = threading.Timer(MOST_WAITING_SECONDS[case.status], process.kill)
        stop.start()
        _, status, used = os.wait4(process.pid, 0)
        stop.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        return process.returncode, errors.read().decode(errors="replace"), used


def answer(case, common):
    """Exit status, stderr, processor time of all processes [s], memory of the largest one [bytes], and the files left
    behind."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        folder.chmod(0o755)
        make(folder, common | case.files)
        (folder / "tmp").mkdir()
        (folder / "tmp").chmod(0o1777)
        before = listing(folder)
        status, told, used = finished(case, folder)
        left = [name for name in sorted(listing(folder) - before) if not is_allowed(name, case.leaves)]
        return status, told, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024, left


def is_allowed(name, leaves):
    in_the_cache = name == "cache" or name.startswith("cache/")
    return in_the_cache and not run_records.is_temporary(pathlib.Path(name)) or name.startswith(leaves or ("/",))


def is_well_formed(line, names):
    """FILE[:LINE[:COLUMN]]: [FIELD = VALUE: ]RULE; without a file, for a word of the command: FIELD = VALUE: RULE; or
    the usage."""
    if USAGE.fullmatch(line):
        return True
    match = LINE.fullmatch(line)
    if not match or not match["place"]:
        return bool(match and match["field"])
    return any(match["place"] == name or match["place"].startswith(name + "/")
               for name in names) or match["place"].startswith("--")


def what_is_wrong_with(told, case, common):
    # On a busy machine a stage takes more than two seconds and is named by a line of its own.
    lines = [line for line in told.splitlines() if not line.endswith(" ...")]
    # the names that the line may use for the place of the error
    names = {*common, *case.files, *map(str, case.command), *(word.split(":")[0] for word in case.says if ": " in word)}
    ours = [line.startswith("pbskin: ") for line in lines if not line.startswith("pbskin: warning: ")]
    if sum(ours) != 1 or not lines[-1].startswith("pbskin: "):
        yield "expected one line that begins with `pbskin: `, and that the last"
    elif any(lines[-1].count(f"{name}: ") > 1 for name in case.files):
        yield "names the file twice"
    elif not is_well_formed(lines[-1], names):
        yield "expected the form `FILE[:LINE]: FIELD = VALUE: RULE`"


def typed(value, case):
    """Whether a value that is not a number occurs in the input; also inside bytes if the case demands it."""
    return any(value in str(text) for text in (*case.files.values(), *case.command)) or any(f"= {value}" in word
                                                                                            for word in case.says)


def problems(case, common):
    """The defects of the answer to `case`; empty if there are none. `common` files exist in every case."""
    status, told, seconds, memory, left = answer(case, common)
    found = [f"exit status {status}, expected {case.status}"] if status != case.status else []
    if case.status == 2:
        found += what_is_wrong_with(told, case, common)
    if not (SANITIZED and UNLIMITED.search(case.name)):
        found += [f"does not say {word!r}" for word in case.says if not any(text in told for text in word.split(" | "))]
    found += [f"says that a value is {value}, which nobody typed" for value in re.findall(NO_NUMBER, told)
              if not typed(value, case)]
    found += [f"says {word!r}" for word in WORDS_OF_NO_USER if word in told]
    found += [f"took {seconds:.1f} s of processor time"] if case.status == 2 and seconds > MOST_SECONDS else []
    found += [f"took {memory >> 20} MB"] if memory > MOST_BYTES else []
    found += [f"left behind: {left[:5]}"] if left else []
    return [f"{case.name}: {problem}\n    {told.strip()[:300]}" for problem in found]


def limit_address_space():
    """Limits this process and all that it starts, so that a run out of control cannot exhaust the machine."""
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
