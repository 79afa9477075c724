"""The page that `pbskin try` writes for a rigged model, in Debian's Chromium. `./check --long` runs this test and sets PBS_LONG=1;
otherwise it is skipped (exit status 77). The model is one of tests/support/rig_files.py.

    PBS_LONG=1 python3 tests/browser/trial_test.py build/release/bin/pbskin SCRATCH
"""
import csv
import json
import shutil
import sys

import browser_test
from browser_test import root, run

sys.path.insert(0, str(root / "tests" / "support"))

import rig_files  # noqa: E402
from drawing import bodies  # noqa: E402
from viewer import data as viewer_data  # noqa: E402

frames = 5
shown = ("lbs", "pbs", "lbs_paper")  # deformers whose surfaces are compared


def sample_of(folder, label, frame):
    """Points of the deformed surface and vertices of the tets [m]."""
    skin_m = bodies.points_of(folder / "frames" / f"{label}_surface_{frame:06}.vtp")
    positions_m = viewer_data.read_frame(folder / "frames" / f"{label}_{frame:06}.vtu")[0]
    return {"label": label, "frame": frame, "skin_m": skin_m.ravel().tolist(), "positions_m": positions_m.ravel().tolist()}


def truth_of(folder):
    trial = json.loads((folder / "try.json").read_text())
    artist_m = bodies.points_of(folder / "skin" / "artist_000000.vtp")
    with open(folder / "metrics.csv", newline="") as stream:
        deformers = list(dict.fromkeys(row["deformer"] for row in csv.DictReader(stream)))
    return {"summary": trial["summary"], "warnings": trial["warnings"], "frames": frames, "points": len(artist_m), "deformers": deformers,
            "samples": [sample_of(folder, label, frame) for label in shown for frame in (0, frames // 2, frames - 1)]}


def main(program, scratch):
    """Returns the exit status."""
    folder, truth = scratch / "trial", scratch / "trial_truth.json"
    shutil.rmtree(folder, ignore_errors=True)
    surroundings = browser_test.built(scratch, viewer_page=folder / "report.html", viewer_truth=truth)
    model = rig_files.write("two_animations", str(scratch / "hero.glb"))  # a warning names the animation that is taken
    run([program, "try", model, "-o", folder, "--frames", str(frames), "--vertices", "400"], env=surroundings)
    truth.write_text(json.dumps(truth_of(folder)))
    return browser_test.status_of("trial/*.test.mjs", surroundings)


if __name__ == "__main__":
    browser_test.run_test(main)
