"""Writes DIR's records and the figures drawn from them as one self-contained page, DIR/report.html, and prints what is missing in it; and
the pages of studies, DIR/STUDY/STUDY.md. Exit status 2 if DIR holds no records.

    python3 paper_figures/make_report.py results/reproduce
    python3 paper_figures/make_report.py --picture RUN    # only RUN/picture.png: the values of a single run over its frames
"""
import pathlib
import sys

import pages
import report

if __name__ == "__main__":
    folders = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    if len(folders) != 1:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    folder = pathlib.Path(folders[0])
    if "--picture" in sys.argv:
        sys.exit(report.picture(folder))
    pages.write(folder)
    sys.exit(report.main(folder, quiet="--quiet" in sys.argv))
