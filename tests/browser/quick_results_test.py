"""The records of a quick run: one make_all draws every figure that can be redrawn in minutes, and their report opens in Debian's Chromium
without errors. `./check --long` runs this test and sets PBS_LONG=1; otherwise it is skipped (exit status 77).

    PBS_LONG=1 python3 tests/browser/quick_results_test.py build/release/bin/pbskin SCRATCH

PBS_QUICK_RESULTS=DIR uses the records of an existing quick run of ./reproduce; otherwise one is made, which takes ten minutes on two cores.
The records are copied, so nothing is written into DIR."""
import os
import pathlib
import shutil
import subprocess
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
    if (status := browser_test.unready()) is not None:
        return status
    scratch.mkdir(parents=True, exist_ok=True)
    folder = quick_records(program, scratch)
    run(["xvfb-run", "-a", sys.executable, "-B", root / "paper_figures" / "make_all.py", folder])  # status 0: every figure was drawn
    undrawn, expected = browser_test.undrawn(folder), lacking(folder)
    redrawn = {entry.name for entry in entries.read() if entry.mark == "R"}
    print(f"{len(redrawn - undrawn)} of {len(redrawn)} figures of mark R drawn; without their studies: {', '.join(sorted(expected))}")
    if undrawn != expected or not redrawn - undrawn:
        print(f"not drawn: {sorted(undrawn)}, expected {sorted(expected)}")
        return 1
    surroundings = {**os.environ, "PBS_VIEWER_BUILD": str(scratch), "PBS_REPORT_PAGE": str(folder / "report.html")}
    run(["node", "build.mjs"], cwd=root / "paper_figures/viewer", env=surroundings)
    run([sys.executable, "-B", root / "paper_figures/make_report.py", "--quiet", folder], env=surroundings)
    return subprocess.run(["node", "--test", root / "tests/browser/report.test.mjs"], env=surroundings).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2]).resolve()))
