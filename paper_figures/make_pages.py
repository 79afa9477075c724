"""Writes the pages of studies for readers, DIR/STUDY/STUDY.md, from their tables.

    python3 paper_figures/make_pages.py results/reproduce
"""
import pathlib
import sys

import pages

if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    for file in pages.write(pathlib.Path(sys.argv[1])):
        print(file)
