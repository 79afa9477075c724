"""Writes DIR's records and the figures drawn from them as one self-contained page, DIR/report.html, and prints what is missing in it. Exit
status 2 if DIR holds no records.

    python3 paper_figures/make_report.py results/reproduce
"""
import pathlib
import sys

import report

if __name__ == "__main__":
    folders = [argument for argument in sys.argv[1:] if argument != "--quiet"]
    if len(folders) != 1:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    sys.exit(report.main(pathlib.Path(folders[0]), quiet="--quiet" in sys.argv))
