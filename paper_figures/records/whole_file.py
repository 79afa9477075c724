"""Writes whole files or none: a figure is drawn into a temporary file in the same folder and renamed, so that a killed
or failed drawing leaves no incomplete file.

    with whole_file.beside(figures / "volume.pdf") as path:
        figure.savefig(path)
"""
import contextlib
import os
import pathlib


class CannotBeWritten(Exception):
    """The error for a full disk or a read-only folder, with the file and the system's reason."""


def is_running(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass
    return True


def remove_halves(path):
    """Removes what killed drawings of this file left behind: .NAME.PROCESS.ENDING."""
    for half in path.parent.glob(f".{path.stem}.*{path.suffix}"):
        process = half.name[len(path.stem) + 2 : -len(path.suffix)]
        if process.isdigit() and not is_running(int(process)):
            half.unlink(missing_ok=True)


def is_of(error, drawn, path):
    """Whether an error concerns the file being written. The system names no file if a write fails, and another one if
    the block could not read that."""
    return error.filename is None or pathlib.Path(os.fsdecode(error.filename)) in (drawn, path, *path.parents)


@contextlib.contextmanager
def beside(path):
    """A path with the same ending in the same folder; it is renamed to `path` if the block succeeds, otherwise
    removed."""
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
