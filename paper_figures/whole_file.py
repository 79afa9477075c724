"""Whole files or none: a figure is drawn beside its place and renamed into it, so that a killed or failed drawing leaves no half of one.

    with whole_file.beside(figures / "volume.pdf") as path:
        figure.savefig(path)
"""
import contextlib
import os


class CannotBeWritten(Exception):
    """What a full disk or a read-only folder ends in: the file and the system's reason."""


def is_running(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


def remove_halves(path):
    """What drawings of this file that were killed left: .NAME.PROCESS.ENDING."""
    for half in path.parent.glob(f".{path.stem}.*{path.suffix}"):
        process = half.name[len(path.stem) + 2 : -len(path.suffix)]
        if process.isdigit() and not is_running(int(process)):
            half.unlink(missing_ok=True)


@contextlib.contextmanager
def beside(path):
    """A path with the same ending in the same folder; renamed to `path` where the block ends well, else removed."""
    drawn = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    remove_halves(path)
    try:
        yield drawn
        drawn.replace(path)
    except OSError as error:
        raise CannotBeWritten(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        drawn.unlink(missing_ok=True)
