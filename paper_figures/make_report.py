"""Writes DIR's records and the figures drawn from them as one self-contained page, DIR/report.html, and prints what is
missing in it; and the pages of studies, DIR/STUDY/STUDY.md. Exit status 2 if DIR holds no records, or damaged ones; 3
if the page of a run lacks the moving model and --needs-model asks for it; 4 if this Python cannot import what draws.

    python3 paper_figures/make_report.py results/reproduce
    python3 paper_figures/make_report.py --picture RUN    # only RUN/picture.png: the values of one run over its frames
"""
import argparse
import os
import pathlib
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # OpenBLAS's idle threads would keep the processors busy

try:
    import matplotlib
    import numpy
except ImportError as error:
    print(f"{sys.executable}: {error}", file=sys.stderr)
    sys.exit(4)

import pages
import report


def main(folder, quiet=False, needs_model=False):
    status = report.main(folder, quiet, needs_model)
    return pages.write(folder)[1] or status


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="DIR", type=pathlib.Path, help="the records of ./reproduce, or the folder "
                                                                          "of a run")
    parser.add_argument("--picture", action="store_true", help="draw only DIR/picture.png")
    parser.add_argument("--needs-model", action="store_true", help="exit status 3 if the page lacks the moving model")
    parser.add_argument("--quiet", action="store_true", help="do not print what is missing")
    chosen = parser.parse_args()
    sys.exit(report.picture(chosen.results) if chosen.picture else main(chosen.results, chosen.quiet,
                                                                        chosen.needs_model))
