#!/usr/bin/env python3
"""Counts for tests/README.md the results of a run of ctest, from its JUnit report.

    PBS_RELIABILITY_DIR=DIR junit_counts.py results/check/tsan.xml tsan "tests without a report of the thread sanitizer"
"""
import os
import pathlib
import sys
import xml.etree.ElementTree

import reliability


def main(report, file, name):
    suite = xml.etree.ElementTree.parse(report).getroot()
    ran = [case for case in suite.iter("testcase") if case.get("status") == "run" or case.find("failure") is not None]
    passed = [case for case in ran if case.find("failure") is None]
    reliability.tell(file, name, len(passed), len(ran), command="./check --long")


if __name__ == "__main__":
    os.environ.setdefault("PBS_SOURCE", str(pathlib.Path(__file__).resolve().parents[2]))
    main(*sys.argv[1:])
