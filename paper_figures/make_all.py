"""Deletes DIR/figures and draws the figures of every study in DIR anew from its records; exit status 1 where one could not be drawn, or
DIR holds no study.

    xvfb-run -a python3 paper_figures/make_all.py results/reproduce
"""
import importlib
import pathlib
import shutil
import sys

import records

# Which study's records a figure shows.
figures = {"volume_over_angle": "volume", "volume_over_clip": "volume", "volume_over_iterations": "volume", "frames": "volume",
           "verification": "verification", "error_split": "error_split", "fit": "fit", "work_precision": "work_precision",
           "roofline": "bench", "scaling": "bench"}


def main(results):
    if not results.is_dir():
        sys.exit(f"{results}: no such folder; run ./reproduce first")
    folder = results / "figures"
    shutil.rmtree(folder, ignore_errors=True)
    missing = 0
    if not any((results / study).is_dir() for study in figures.values()):
        sys.exit(f"{results}: no study in it; run ./reproduce first")
    for name, study in figures.items():
        if not (results / study).is_dir():
            print(f"figures: {name} left out: the study {study} was not run")
            continue
        try:
            importlib.import_module(name).draw(results, folder)
            print(f"figures: {folder / name}")
        except records.RecordsMissing as error:
            missing += 1
            print(f"figures: {name} not drawn: {error}", file=sys.stderr)
    return 1 if missing else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))
