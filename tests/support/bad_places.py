"""Places that cannot be written, and command lines that cannot be carried out."""
import os

from bad_case import Case
from bad_surfaces import off

FIGURES = ["measure", "arm.vtu", "arm.vtu"]
DENIED = "Permission denied"


def places():
    yield Case("output folder that is a file", {"out": "text"}, ["run", "arm.toml", "-o", "out"],
               ("out: ", "cannot be made: Not a directory"))
    yield Case("output folder under a file", {"out": "text"}, ["run", "arm.toml", "-o", "out/deeper"],
               ("out/deeper: ", "cannot be made: Not a directory"))
    yield Case("output in /proc", {}, ["run", "arm.toml", "-o", "/proc/pbskin"], ("/proc/pbskin: ", "cannot be made: No such file"))
    yield Case("figures below a device", {}, [*FIGURES, "--csv", "/dev/full/x.csv"], ("/dev/full/x.csv: ", "written: Not a directory"))
    yield Case("figures into a folder that is not there", {}, [*FIGURES, "--csv", "none/x.csv"],
               ("none/x.csv: ", "cannot be written: No such file"))
    yield Case("bench into a file", {"out": "text"}, ["bench", "--quick", "-o", "out"], ("out: ", "cannot be made: Not a directory"))


def devices():
    """Devices, which a file renamed into their place would destroy."""
    rule = "cannot be written: expected a file, or nothing there"
    for kind, make in (("named pipe", os.mkfifo), ("device", lambda path: path.symlink_to("/dev/null"))):
        yield Case(f"figures onto a {kind}", {"x.csv": make}, [*FIGURES, "--csv", "x.csv"], ("x.csv: ", rule))
        yield Case(f"report of tests onto a {kind}", {"x.xml": make}, [*FIGURES, "--junit", "x.xml"], ("x.xml: ", rule))
        yield Case(f"tets onto a {kind}", {"x.vtu": make, "good.off": off()}, ["mesh", "good.off", "-o", "x.vtu", "--vertices", "200"],
                   ("x.vtu: ", rule))


def locked(path):
    """A folder that is read-only."""
    path.mkdir(mode=0o555)


def read_only_places():
    made, written = "cannot be made: " + DENIED, "cannot be written: " + DENIED
    for number, (place, command, rule) in enumerate((("locked", ["run", "arm.toml", "-o"], made),
                                                     ("locked/deeper", ["run", "arm.toml", "-o"], made),
                                                     ("locked/x.csv", [*FIGURES, "--csv"], written),
                                                     ("locked/x.xml", [*FIGURES, "--junit"], written),
                                                     ("locked", ["bench", "--quick", "-o"], written),
                                                     ("locked", ["reproduce", "momentum", "-o"], made))):
        yield Case(f"read-only folder {number}", {"locked": locked}, [*command, place], (place, rule), as_nobody=True)


def command_lines():
    yield Case("no verb", {}, [], ("A subcommand is required",))
    yield Case("unknown verb", {}, ["dance"], ("A subcommand is required",))
    yield Case("threads out of range", {}, ["run", "arm.toml", "--threads", "0"], ("--threads: Value 0 not in range 1 to 1024",))
    yield Case("unknown study", {}, ["reproduce", "alchemy", "-o", "out"], ("reproduce = alchemy: unknown claim or study",))
    yield Case("fetch an unknown body", {}, ["fetch", "dragon"], ("dragon not in {man,lady,frankie}",))


def cases():
    yield from places()
    yield from devices()
    yield from read_only_places()
    yield from command_lines()
