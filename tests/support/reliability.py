#!/usr/bin/env python3
"""Writes the counts of the reliability tests for tests/README.md to FILE.json in the folder that PBS_RELIABILITY_DIR
names; without it, nothing is written.

    reliability.tell("kills", "kills survived", 20, 20, note="seed 2014")

As a program, it counts the results of a run of ctest from its JUnit report, or how many lines of the project's code the
tests ran from gcovr's summary, with exit status 1 if too few:

    PBS_RELIABILITY_DIR=DIR reliability.py results/check/tsan.xml tsan "tests without a report of the thread sanitizer"
    PBS_RELIABILITY_DIR=DIR reliability.py results/check/coverage.json
"""
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

least_percent = 85.0


def revision():
    described = subprocess.run(["git", "-C", os.environ["PBS_SOURCE"], "rev-parse", "HEAD"], capture_output=True,
                               text=True)
    return described.stdout.strip() or "unknown"


def tell(file, name, count, of, **facts):
    print(f"{name}: {count} of {of}", facts or "", file=sys.stderr)
    if not (folder := os.environ.get("PBS_RELIABILITY_DIR")):
        return
    told = pathlib.Path(folder, f"{file}.json")
    told.parent.mkdir(parents=True, exist_ok=True)
    command = ("PBS_LONG=1 " if os.environ.get("PBS_LONG")
               else "") + os.path.relpath(sys.argv[0], os.environ["PBS_SOURCE"])
    record = {"name": name, "count": count, "of": of, "command": command, "revision": revision(), **facts}
    beside = told.with_suffix(".part")
    beside.write_text(json.dumps(record, indent=2) + "\n")
    beside.replace(told)


def tell_tests(report, file, name):
    ran = [case for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase")
           if case.get("status") == "run" or case.find("failure") is not None]
    tell(file, name, len([case for case in ran if case.find("failure") is None]), len(ran), command="./check --long")


def tell_coverage(summary):
    lines = json.loads(pathlib.Path(summary).read_text())
    percent = 100.0 * lines["line_covered"] / lines["line_total"]
    tell("coverage", "lines of our own C++ that the tests run (gcovr)", lines["line_covered"], lines["line_total"],
         command="./check --long", note=f"{percent:.1f} %")
    if percent < least_percent:
        sys.exit(f"{percent:.2f} % of the lines: expected at least {least_percent:g} %")


if __name__ == "__main__":
    os.environ.setdefault("PBS_SOURCE", str(pathlib.Path(__file__).resolve().parents[2]))
    (tell_coverage if sys.argv[1].endswith(".json") else tell_tests)(*sys.argv[1:])
