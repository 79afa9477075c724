"""Files that are whole or not there."""
import contextlib
import os
import pathlib
import tempfile


@contextlib.contextmanager
def atomic_text(path):
    """A UTF-8 text file to write to, beside its place and renamed at the end; at an error nothing of it is left. Folders are made."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=f".{path.name}.", delete=False, newline="", encoding="utf-8") as file:
        try:
            yield file
            file.flush()
            os.fsync(file.fileno())
            os.fchmod(file.fileno(), 0o644)
            os.replace(file.name, path)
        except BaseException:
            os.unlink(file.name)
            raise


def write_atomically(path, text):
    with atomic_text(path) as file:
        file.write(text)
