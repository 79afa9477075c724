"""Deletes DIR/figures and draws every figure anew from the records in DIR; exit status 1 where one could not be drawn.

    xvfb-run -a python3 paper_figures/make_all.py results/reproduce
"""
import importlib
import pathlib
import shutil
import sys

import records

figures = ["volume_over_angle", "volume_over_clip", "volume_over_iterations", "frames"]


def main(results):
    if not results.is_dir():
        sys.exit(f"{results}: no such folder; run ./reproduce first")
    folder = results / "figures"
    shutil.rmtree(folder, ignore_errors=True)
    missing = 0
    for name in figures:
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
