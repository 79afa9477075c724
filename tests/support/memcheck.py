#!/usr/bin/env python3
"""Runs the programs of the unit tests under valgrind with a full search for leaks, and counts for tests/README.md how
many were clean. Errors of other libraries are listed in valgrind_suppressions.txt, each with its reason.

    PBS_RELIABILITY_DIR=DIR memcheck.py build/valgrind/tests JOBS
"""
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import reliability

LIMIT_S = 300  # per program
# compares GSL's mean to the bit, for which valgrind lacks the 80-bit numbers
LEFT_OUT = {"test_unit_analysis": "VolumeIsPreserved.BreakdownDoesNotHold"}
SUPPRESSIONS = pathlib.Path(__file__).with_name("valgrind_suppressions.txt")
VALGRIND = ["valgrind", "-q", "--error-exitcode=9", "--leak-check=full", "--num-callers=20",
            f"--suppressions={SUPPRESSIONS}"]


def run(program):
    """(name of the program, number of tests that ran, errors)"""
    with tempfile.NamedTemporaryFile(suffix=".xml") as report:
        command = [*VALGRIND, str(program), f"--gtest_filter=-{LEFT_OUT.get(program.name, '')}", "--gtest_brief=1",
                   f"--gtest_output=xml:{report.name}"]
        try:
            ended = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=LIMIT_S)
        except subprocess.TimeoutExpired:
            return program.name, 0, f"not done after {LIMIT_S} s"
        if ended.returncode != 0:
            return program.name, 0, f"exit status {ended.returncode}\n{ended.stdout}{ended.stderr}"
        return program.name, int(xml.etree.ElementTree.parse(report.name).getroot().get("tests")), ""


def main(folder, jobs):
    programs = sorted(path for path in pathlib.Path(folder).glob("test_unit_*") if os.access(path, os.X_OK))
    clean = tests = 0
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        for name, ran, wrong in pool.map(run, programs):
            clean, tests = clean + (not wrong), tests + ran
            if wrong:
                print(f"{name}: {wrong}", file=sys.stderr)
    reliability.tell("valgrind", "programs of unit tests of the method and the metrics without an error or a leak "
                                 "found by valgrind", clean,
                     len(programs), command="./check --long", note=f"{tests:,} tests")
    return 0 if programs and clean == len(programs) else 1


if __name__ == "__main__":
    os.environ.setdefault("PBS_SOURCE", str(pathlib.Path(__file__).resolve().parents[2]))
    sys.exit(main(*sys.argv[1:]))
