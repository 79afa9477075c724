"""A quick run's own records: every figure that can be redrawn in minutes is drawn of them by one make_all, and the report of them opens in
Debian's Chromium without a complaint. Run by `./check --long`, which sets PBS_LONG=1; without, the test is skipped (exit status 77).

    PBS_LONG=1 python3 tests/browser/quick_results_test.py build/release/bin/pbskin SCRATCH

PBS_QUICK_RESULTS=DIR takes the records of a quick run that is there, as ./reproduce leaves them; else one is made, which takes ten minutes
on two cores. The records are copied: nothing is written into DIR."""
import os
import pathlib
import shutil
import subprocess
import sys

import browser_test
from browser_test import bound_missed, root, run

import entries


def quick_records(program, scratch):
    """A folder of its own with a quick run's records, without figures."""
    folder = scratch / "records"
    shutil.rmtree(folder, ignore_errors=True)
    given = os.environ.get("PBS_QUICK_RESULTS")
    if given:
        shutil.copytree(given, folder, ignore=shutil.ignore_patterns("figures", "report.html"))
    else:
        run([program, "reproduce", "--quick", "--quiet", "-o", folder], [bound_missed])
    return folder


def lacking(folder):
    """Figures of studies that the quick set has not."""
    return {entry.name for entry in entries.read() if any(not (folder / study).is_dir() for study in entry.studies())}


def main(program, scratch):
    """Exit status."""
    if (status := browser_test.unready()) is not None:
        return status
    scratch.mkdir(parents=True, exist_ok=True)
    folder = quick_records(program, scratch)
    run(["xvfb-run", "-a", sys.executable, "-B", root / "paper_figures" / "make_all.py", folder])  # 0: none that could not be drawn
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
