"""Deletes the figures of DIR and draws those of figures.toml anew from its records. A figure that cannot be drawn, for
example because its records are missing or stale, is named with the cause, which NAME.cause.txt keeps for the report,
and the exit status is 1. A figure whose study has no folder in DIR, or whose run the default form of its study does not
have, was not requested: it is drawn from the kept record that judges DIR, or else named and left out, and the status
stays 0. Status 0 therefore means that every figure of the studies in DIR was drawn. If DIR holds no study at all, the
status is 1. If only some of the planned runs have records, the figure is drawn and its caption names the others. If a
file cannot be written, it is named and the exit status is 2.

    xvfb-run -a python3 paper_figures/make_all.py results/reproduce
    xvfb-run -a python3 paper_figures/make_all.py results/reproduce --only error_against_time --into elsewhere
"""
import argparse
import os
import pathlib
import shutil
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # OpenBLAS's idle threads would keep the processors busy

import records
from drawing import style
from records import entries, kept, whole_file
from words import captions

endings = ("pdf", "png", "svg", "csv", "tex", "webp", "mp4", "title.txt", "caption.txt", "cause.txt")


def delete(name, folder):
    for ending in endings:
        (folder / f"{name}.{ending}").unlink(missing_ok=True)


def draw(entry, results, folder):
    """Draws a figure; returns the cause if it cannot be drawn, which NAME.cause.txt states as well."""
    try:
        style.need_font()
        entry.check(results)
        figure, rows, further = entry.draw(results)
        origin = entry.origin(results)
        style.save(figure, folder / entry.name, origin, rows)
        for ending, write in further.items():
            with whole_file.beside(folder / f"{entry.name}.{ending}") as path:
                write(path, origin)
        captions.write(entry, results, folder)
    except Exception as error:  # one figure must not keep the others from being drawn
        cause = (error if isinstance(error, records.RecordsMissing) else "internal error, please report it: "
                                                                         f"{type(error).__name__}: {error}")
        delete(entry.name, folder)
        line = " ".join(str(cause).split())
        with whole_file.beside(folder / f"{entry.name}.cause.txt") as path:
            path.write_text(f"{line}\n", encoding="utf-8")
        return line
    print(f"figures: {folder / entry.name}")
    return None


def is_kept(entry, record):
    """Whether the kept record has all that the figure needs."""
    try:
        return not entries.not_asked_for(entry, record) and bool(entry.files(record))
    except records.RecordsMissing:
        return False


def main(results, only=None, folder=None):
    if not results.is_dir():
        sys.exit(f"{results}: no such folder; run ./reproduce first")
    listed = entries.read()
    if not any((results / study).is_dir() for entry in listed for study in entry.studies()):
        for entry in listed:  # removes figures whose records no longer exist
            delete(entry.name, results / "figures")
        sys.exit(f"{results}: no study in it; run ./reproduce first")
    if only and only not in {entry.name for entry in listed}:
        sys.exit(f"{only}: no such figure; there are {', '.join(entry.name for entry in listed)}")
    if not only and not folder:
        shutil.rmtree(results / "figures", ignore_errors=True)
    folder = folder or results / "figures"
    record = kept.record_behind(results)
    results, record = kept.opened(results), record and kept.opened(record)
    causes = {}
    for entry in listed:
        if only not in (None, entry.name):
            continue
        delete(entry.name, folder)
        reason = entries.not_asked_for(entry, results)
        if reason and not only:
            if not (record and is_kept(entry, record) and not draw(entry, record, folder)):
                delete(entry.name, folder)
                print(f"figures: {entry.name} left out: {reason}")
        elif cause := draw(entry, results, folder):
            causes.setdefault(cause, []).append(entry.name)
    for cause, names in causes.items():
        print(f"figures: {', '.join(names)} not drawn: {cause}", file=sys.stderr)
    return 1 if causes else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="DIR", type=pathlib.Path, help="the records of ./reproduce")
    parser.add_argument("--only", metavar="NAME", help="draw only this figure")
    parser.add_argument("--into", metavar="FOLDER", type=pathlib.Path, help="folder of the figures (default: "
                                                                            "DIR/figures)")
    chosen = parser.parse_args()
    try:
        sys.exit(main(chosen.results, chosen.only, chosen.into))
    except whole_file.CannotBeWritten as error:
        print(f"figures: {error}", file=sys.stderr)
        sys.exit(2)
