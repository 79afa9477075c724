"""Whole files or none: a figure is drawn beside its place and renamed into it, so that a killed or failed drawing leaves no half of one.

    with whole_file.beside(figures / "volume.pdf") as path:
        figure.savefig(path)
"""
import contextlib
import os
import pathlib


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


def is_of(error, drawn, path):
    """Of the file that is written; the system names none where a write fails, and another where the block could not read that."""
    return error.filename is None or pathlib.Path(os.fsdecode(error.filename)) in (drawn, path, *path.parents)


@contextlib.contextmanager
def beside(path):
    """A path with the same ending in the same folder; renamed to `path` where the block ends well, else removed."""
    drawn = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        remove_halves(path)
        yield drawn
        drawn.replace(path)
    except OSError as error:
        if not is_of(error, drawn, path):
            raise
        raise CannotBeWritten(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        with contextlib.suppress(OSError):
            drawn.unlink(missing_ok=True)
