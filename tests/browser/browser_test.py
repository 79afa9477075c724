"""Three tests in Debian's Chromium, with software rendering; each is a function of a program and a folder that returns
the exit status. `./check --long` runs them and sets PBS_LONG=1; with that, missing programs fail the test, otherwise it
is skipped (exit status 77).

    PBS_LONG=1 python3 tests/browser/browser_test.py build/release/bin/pbskin SCRATCH viewer

viewer: the report and its viewer. PBS_BROWSER_RESULTS=DIR uses the records and figures of an existing run. Otherwise
the kept records are judged again, the studies `frames` and `audit` are run (a minute or two), and all figures are drawn
that these records allow. quick_results: the report of a quick run. PBS_QUICK_RESULTS=DIR uses the records of an
existing quick run of ./reproduce, which are copied; otherwise one is made, which takes ten minutes on two cores. trial:
the page of a model of tests/support/rig_files.py."""
import csv
import fnmatch
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy

root = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(root / "paper_figures"), str(root / "tests" / "support")]

import rig_files  # noqa: E402
from drawing import bodies  # noqa: E402
from records import entries, kept  # noqa: E402
from viewer import data as viewer_data, page as viewer_html  # noqa: E402

skipped = 77
bound_missed = figure_missed = 1  # exit statuses for a bound that does not hold, and for a figure that was not drawn
sampled = {"limb_twist": ["lbs", "nh_p1"], "limb_bend": ["dqs"], "human_jump": ["pbs", "dqs"],
           "human_walk": ["pbs_jiggle"]}
with_bones = "limb_bend"  # the whole limb is visible, and its skeleton moves
# The kept records contain the verdicts, but not all tables.
not_of_these_records = {"clip_temporal", "convergence_iterations", "scaling", "section_profiles", "stability_cells",
                        "volume_by_region"}
sampled_skins = {"human_jump": ["pbs"], "human_walk": ["lbs", "pbs_jiggle"]}
columns = ("volume_change_pct", "inverted_tets", "j_min", "error_joint_pct", "error_linf_m", "skin_rms_mm")


def what_is_missing():
    found = {"node": shutil.which("node"), "npm": shutil.which("npm"),
             "chromium": pathlib.Path("/usr/bin/chromium").exists(), "xvfb-run": shutil.which("xvfb-run"),
             "paper_figures/viewer/node_modules (npm "
             "ci there)": (root / "paper_figures/viewer/node_modules/playwright-core").exists()}
    return [name for name, there in found.items() if not there]


def recorded(program, scratch):
    """A folder with DIR/frames, verdicts and figures."""
    if os.environ.get("PBS_BROWSER_RESULTS"):
        return pathlib.Path(os.environ["PBS_BROWSER_RESULTS"]).resolve()
    folder = scratch / "records"
    kept.expand(root / "experiments" / "records" / "full", folder)
    reproduce = [program, "reproduce", "--quiet", "-o", folder]
    run([*reproduce, "--resume", "frames", "audit"], [bound_missed])
    run([*reproduce, "--judge"], [bound_missed])  # of all existing records
    run(["xvfb-run", "-a", sys.executable, "-B", root / "paper_figures" / "make_all.py", folder], [figure_missed])
    missed = undrawn(folder)
    if missed != not_of_these_records:
        sys.exit(f"not drawn: {sorted(missed)}, expected {sorted(not_of_these_records)}")
    return folder


def run(command, accepted=(), **options):
    """Ends the test on any exit status except 0 and the accepted ones."""
    status = subprocess.run(command, stdout=subprocess.DEVNULL, **options).returncode
    if status not in (0, *accepted):
        sys.exit(f"{' '.join(map(str, command))}: exit status {status}")


def undrawn(folder):
    """The figures that the report cannot show."""
    there = {file.stem for file in (folder / "figures").glob("*") if file.suffix in (".svg", ".png", ".webp")}
    return {entry.name for entry in entries.read()} - there


def sample_of(frames, label, frame):
    """Positions [m], ratios and distances to the reference [m] by VTK's reader, numbers from the row of metrics.csv,
    midpoints of bones [m]."""
    row, reference = frames.row(label, frame), frames.run.reference()
    positions, _, ratios, rest, depths = viewer_data.read_frame(frames.tets(label, frame))
    truth_m = viewer_data.read_frame(frames.tets(reference, frame))[0]
    middles = ([((bone.head + bone.tail) / 2).tolist() for bone in frames.bones(frame)] if frames.run.name == with_bones
               else None)
    return {"run": frames.run.name, "label": label, "frame": frame, "positions_m": positions.ravel().tolist(),
            "ratios": ratios.tolist(), "depths_um": depths.tolist(), "mm_per_m": mm_per_m(rest),
            "distances_m": numpy.linalg.norm(positions - truth_m, axis=1).tolist(), "reference": reference,
            "bones": middles, "figures": {column: row[column] for column in columns if row[column]}}


def skin_sample_of(frames, label, frame):
    """Points of the rendered surface [m] as recorded, followed by the vertices of the tets."""
    skin_m = bodies.points_of(frames.skin(label, frame))
    return {**sample_of(frames, label, frame), "skin_m": skin_m.ravel().tolist()}


def mm_per_m(rest):
    """Millimetres of a body whose largest extent is 1.7 m."""
    return 1700 / numpy.ptp(rest, axis=0).max()


def distance_of_99_pct_mm(frames):
    """The distance from the reference that one in a hundred vertices exceeds, over all frames and deformers."""
    distances_mm = []
    for frame in range(len(frames.times_s())):
        truth_m, _, _, rest, _ = viewer_data.read_frame(frames.tets(frames.run.reference(), frame))
        others = [viewer_data.read_frame(frames.tets(label, frame))[0] for label in frames.deformers
                  if label != frames.run.reference()]
        distances_mm += [mm_per_m(rest) * numpy.linalg.norm(one - truth_m, axis=1) for one in others]
    return float(numpy.percentile(numpy.concatenate(distances_mm), 99))


def truth_of(results):
    runs = viewer_data.recorded_runs(results)
    every = viewer_html.pack(runs)[0]["every"]
    samples, skins = [], []
    for frames in runs:
        packed = range(0, len(frames.times_s()), every)
        first, middle, last = packed[0], packed[len(packed) // 2], packed[-1]
        samples += [sample_of(frames, label, frame) for label in sampled.get(frames.run.name, [])
                    for frame in (first, middle, last)]
        skins += [skin_sample_of(frames, label, frame) for label in sampled_skins.get(frames.run.name, [])
                  for frame in (middle, last)]
    return {"samples": samples, "skins": skins, "undrawn": sorted(undrawn(results)),
            "colours": viewer_html.colours(), "distance_of_99_pct_mm": {frames.run.name: distance_of_99_pct_mm(frames)
                                                                        for frames in runs},
            "poses": viewer_html.poses_of([viewer_data.facts_of(frames, every) for frames in runs])}


def unready():
    """The exit status if the test cannot run, after printing the reason; otherwise None."""
    missing = what_is_missing()
    if not os.environ.get("PBS_LONG"):
        print("skipped: part of ./check --long" + (f"; missing here: {', '.join(missing)}" if missing else ""))
        return skipped
    if missing:
        print(f"missing: {', '.join(missing)}")
        return 1
    return None


def built(scratch, **names):
    """The environment of the tests, with the viewer's program built into `scratch`, and names of files."""
    surroundings = {**os.environ, "PBS_VIEWER_BUILD": str(scratch), "PBS_VIEWER_PICTURES": str(scratch),
                    **{f"PBS_{name.upper()}": str(file) for name, file in names.items()}}
    run(["node", "build.mjs"], cwd=root / "paper_figures/viewer", env=surroundings)
    return surroundings


def report(results, surroundings):
    run([sys.executable, "-B", root / "paper_figures/make_report.py", "--quiet", results], env=surroundings)


def status_of(pattern, surroundings, *options):
    """The exit status of the tests in these files."""
    tests = sorted(str(file) for file in pathlib.Path(__file__).parent.glob(pattern))
    return subprocess.run(["node", "--test", *options, *tests], env=surroundings).returncode


def viewer(program, scratch):
    """The report and its viewer, from kept and new records."""
    results, page, truth = recorded(program, scratch), scratch / "viewer.html", scratch / "truth.json"
    surroundings = built(scratch, viewer_page=page, viewer_truth=truth, report_page=results / "report.html")
    truth.write_text(json.dumps(truth_of(results)))
    run([sys.executable, "-B", "-m", "viewer.page", results, page], cwd=root / "paper_figures", env=surroundings)
    report(results, surroundings)
    return status_of("*.test.mjs", surroundings)


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
    """Figures of studies and of runs that are not in the quick set."""
    plans = {file.parent.name: [run["name"] for run in json.loads(file.read_text())["runs"]]
             for file in folder.glob("*/plan.json")}
    return {entry.name for entry in entries.read()
            for study, *run in (pattern.split("/")[:-1] for pattern in entry.records)
            if study not in plans or (run and not fnmatch.filter(plans[study], run[0]))}


def quick_results(program, scratch):
    """One make_all draws every figure that can be redrawn in minutes, and their report opens without errors."""
    folder = quick_records(program, scratch)
    # Status 0: every figure was drawn.
    run(["xvfb-run", "-a", sys.executable, "-B", root / "paper_figures" / "make_all.py", folder])
    left, expected = undrawn(folder), lacking(folder)
    redrawn = {entry.name for entry in entries.read() if entry.mark == "R"}
    print(f"{len(redrawn - left)} of {len(redrawn)} figures of mark R drawn; without their studies: "
          f"{', '.join(sorted(expected))}")
    if left != expected or not redrawn - left:
        print(f"not drawn: {sorted(left)}, expected {sorted(expected)}")
        return 1
    surroundings = built(scratch, report_page=folder / "report.html")
    report(folder, surroundings)
    return status_of("page.test.mjs", surroundings, "--test-name-pattern=^the report")


trial_frames = 5
compared = ("lbs", "pbs", "lbs_paper")  # deformers whose surfaces are compared


def trial_sample_of(folder, label, frame):
    """Points of the deformed surface and vertices of the tets [m]."""
    skin_m = bodies.points_of(folder / "frames" / f"{label}_surface_{frame:06}.vtp")
    positions_m = viewer_data.read_frame(folder / "frames" / f"{label}_{frame:06}.vtu")[0]
    return {"label": label, "frame": frame, "skin_m": skin_m.ravel().tolist(),
            "positions_m": positions_m.ravel().tolist()}


def truth_of_trial(folder):
    facts = json.loads((folder / "try.json").read_text())
    artist_m = bodies.points_of(folder / "skin" / "artist_000000.vtp")
    with open(folder / "metrics.csv", newline="") as stream:
        deformers = list(dict.fromkeys(row["deformer"] for row in csv.DictReader(stream)))
    samples = [trial_sample_of(folder, label, frame) for label in compared
               for frame in (0, trial_frames // 2, trial_frames - 1)]
    return {"summary": facts["summary"], "warnings": facts["warnings"], "notes": facts["notes"], "frames": trial_frames,
            "points": len(artist_m), "deformers": deformers, "samples": samples}


def trial(program, scratch):
    """The pages that `pbskin try` writes for a rigged model: with a reference, and without one from a centimetre to ten
    kilometres."""
    folder, truth = scratch / "trial", scratch / "trial_truth.json"
    surroundings = built(scratch, viewer_page=folder / "report.html", viewer_truth=truth)
    model = rig_files.write("two_animations", str(scratch / "hero.glb"))  # a warning names the animation that is taken
    for options in ([], ["--no-reference"], ["--no-reference", "--scale", "0.01"],
                    ["--no-reference", "--scale", "10000"]):
        shutil.rmtree(folder, ignore_errors=True)
        run([program, "try", model, "-o", folder, "--frames", str(trial_frames), "--vertices", "400", "--paraview",
             *options],
            env=surroundings)
        truth.write_text(json.dumps(truth_of_trial(folder)))
        if status := status_of("trial/*.test.mjs", surroundings):
            print(f"pbskin try {' '.join(options)}")
            return status
    return 0


if __name__ == "__main__":
    if (status := unready()) is None:
        folder = pathlib.Path(sys.argv[2]).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        status = {"viewer": viewer, "quick_results": quick_results, "trial": trial}[sys.argv[3]](sys.argv[1], folder)
    sys.exit(status)
