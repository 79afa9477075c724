"""The records of a quick run: one make_all draws every figure that can be redrawn in minutes, and their report opens in Debian's Chromium
without errors. `./check --long` runs this test and sets PBS_LONG=1; otherwise it is skipped (exit status 77).

    PBS_LONG=1 python3 tests/browser/quick_results_test.py build/release/bin/pbskin SCRATCH

PBS_QUICK_RESULTS=DIR uses the records of an existing quick run of ./reproduce; otherwise one is made, which takes ten minutes on two cores.
The records are copied, so nothing is written into DIR."""
import os
import shutil
import sys

import browser_test
from browser_test import bound_missed, root, run

from records import entries


def quick_records(program, scratch):
    """A new folder with the records of a quick run, without figures."""
    folder = scratch / "records"
    shutil.rmtree(folder, ignore_errors=True)
    given = os.environ.get("PBS_QUICK_RESULTS")
    if given:
        shutil.copytree(given, folder, ignore=shutil.ignore_patterns("figures", "report.html"))
    else:
        run([program, "reproduce", "--quick", "--quiet", "-o", folder], [bound_missed])
    return folder


def lacking(folder):
    """Figures of studies that are not in the quick set."""
    return {entry.name for entry in entries.read() if any(not (folder / study).is_dir() for study in entry.studies())}


def main(program, scratch):
    """Returns the exit status."""
    folder = quick_records(program, scratch)
    run(["xvfb-run", "-a", sys.executable, "-B", root / "paper_figures" / "make_all.py", folder])  # status 0: every figure was drawn
    undrawn, expected = browser_test.undrawn(folder), lacking(folder)
    redrawn = {entry.name for entry in entries.read() if entry.mark == "R"}
    print(f"{len(redrawn - undrawn)} of {len(redrawn)} figures of mark R drawn; without their studies: {', '.join(sorted(expected))}")
    if undrawn != expected or not redrawn - undrawn:
        print(f"not drawn: {sorted(undrawn)}, expected {sorted(expected)}")
        return 1
    surroundings = browser_test.built(scratch, report_page=folder / "report.html")
    browser_test.report(folder, surroundings)
    return browser_test.status_of("report.test.mjs", surroundings)


if __name__ == "__main__":
    browser_test.run_test(main)
