"""Writes the pages of studies for readers, DIR/STUDY/STUDY.md, from their tables. Exit status 2 without records, or for
damaged ones.

    python3 paper_figures/make_pages.py results/reproduce
"""
import argparse
import pathlib
import sys

import pages

if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="DIR", type=pathlib.Path, help="the records of ./reproduce")
    results = parser.parse_args().results
    written, status = pages.write(results)
    print(*written, sep="\n")
    if not written and status == 0:
        parser.error(f"{results}: no records of a study that has a page; run ./reproduce first")
    sys.exit(status)
