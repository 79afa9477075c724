#!/usr/bin/env python3
"""Counts for tests/README.md how many lines of the project's code the tests ran, from gcovr's summary; exit status 1 if too few.

    PBS_RELIABILITY_DIR=DIR coverage_lines.py results/check/coverage.json
"""
import json
import os
import pathlib
import sys

import reliability

least_percent = 85.0


def main(summary):
    lines = json.loads(pathlib.Path(summary).read_text())
    covered, total = lines["line_covered"], lines["line_total"]
    percent = 100.0 * covered / total
    reliability.tell("coverage", "lines of our own C++ that the tests run (gcovr)", covered, total, command="./check --long",
                     note=f"{percent:.1f} %")
    if percent < least_percent:
        sys.exit(f"{percent:.2f} % of the lines: expected at least {least_percent:g} %")


if __name__ == "__main__":
    os.environ.setdefault("PBS_SOURCE", str(pathlib.Path(__file__).resolve().parents[2]))
    main(*sys.argv[1:])
