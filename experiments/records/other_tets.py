#!/usr/bin/env python3
"""Measures what other tets of the same surface do to the verdicts: meshes the human and the limb anew in sizes that
differ by up to a tenth, repeats their runs on these tets, and judges every claim with the kept records of all other
runs. Writes experiments/records/other_tets.csv, a row for each claim and mesh, with 1.00 for that of the record;
`least` and `most` are the values of human and limb alone, `held_out` the verdict on the held-out cases. It takes about
an hour of processor time for each mesh, and goes on where it was interrupted.

    python3 experiments/records/other_tets.py build/release/bin/pbskin results/other_tets
"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "paper_figures"))
from records import kept  # noqa: E402

SIZES = (0.90, 0.95, 1.02, 1.05)  # number of vertices over that of the body's own mesh, which is the fifth
OWN_TETS = HERE.parent / "references" / "tets"
WANTED_VERTICES = {"human": 2400, "limb": 1775}  # the mesher's aim for the mesh of the record
VERTICES_OF_RECORD = {"human": 2325, "limb": 1780}
SCENES = {"human": "human_01_01", "limb": "limb_twist"}
# The runs whose values decide claims. human_stop and the comparisons with quadratic elements decide none; those over
# several sizes have several meshes already.
RUNS = {
    "volume": ("human_01_01", "human_01_03", "human_range_"),
    "convergence": ("human", "human_range", "limb_twist", "limb_bend"),
    "artefacts": ("human_", "limb_twist", "limb_bend"),
    "momentum": ("human", "limb"),
    "stability": ("pbs", "pbs_human"),
    "jiggle": ("human_jolt", "limb_jolt", "limb_reference"),
    "stiffness": ("iterations_human", "iterations_limb", "time_step_human", "time_step_limb"),
}
COLUMNS = ("claim", "size", "human_vertices", "limb_vertices", "verdict", "held_out", "measured", "cases", "holding",
           "least", "most", "unit")


def runs_of(study, record):
    planned = [run["name"] for run in json.loads((record / "plans.json").read_text(encoding="utf-8"))[study]["runs"]]
    return [name for name in planned for wanted in RUNS[study] if name == wanted or wanted.endswith("_")
            and name.startswith(wanted)]


def mesh(pbskin, body, size, folder):
    """The tets of another size, stored as if they were those of the body's own mesh. Returns their number of
    vertices."""
    wanted = round(size * WANTED_VERTICES[body])
    with tempfile.TemporaryDirectory() as scratch:
        environment = os.environ | {"PBSKIN_CACHE": scratch}
        settings = (f"character.vertices={wanted}", "motion.frames=2" if body == "limb" else "motion.duration_s=0.04",
                    'deformers.use=["lbs"]', "reference.name=", "output.frames=[]", "output.frame_names=[]")
        subprocess.run([pbskin, "run", SCENES[body], "-o", f"{scratch}/run",
                        *(word for key in settings for word in ("--set", key))],
                       env=environment, check=True, stdout=subprocess.DEVNULL)
        made, = pathlib.Path(scratch).glob(f"{body}-{wanted}-*.vtu")
        own, = OWN_TETS.glob(f"{body}-{WANTED_VERTICES[body]}-*.vtu")
        key, content = own.stem.rpartition("-")[0], made.stem.rpartition("-")[2]
        for old in folder.glob(f"{body}-*.vtu"):
            old.unlink()
        shutil.copyfile(made, folder / f"{key}-{content}.vtu")
        return json.loads((pathlib.Path(scratch) / "run" / "run.json").read_text(encoding="utf-8"))["character"][
            "vertices"]


def measure(pbskin, record, size, folder):
    """Returns the number of vertices of each body."""
    tets = folder / "references" / "tets"
    tets.mkdir(parents=True, exist_ok=True)
    vertices = {body: mesh(pbskin, body, size, tets) for body in WANTED_VERTICES}
    environment = os.environ | {"PBSKIN_REFERENCES": str(tets.parent)}
    for study in RUNS:
        only = [word for run in runs_of(study, record) for word in ("--only", run)]
        subprocess.run([pbskin, "reproduce", study, "--full", "--resume", *only, "-o", folder / "runs"],
                       # Status 1: its numbers are not those of the record.
                       env=environment, stdout=subprocess.DEVNULL, check=False)
    return vertices


def judge(pbskin, record, measured):
    """The claims of the record, with these runs in place of its own if there are any."""
    with tempfile.TemporaryDirectory() as scratch:
        both = pathlib.Path(scratch) / "both"
        kept.expand(record, both)
        for study in RUNS if measured else ():
            for run in runs_of(study, record):
                if not (measured / study / run / "run.json").is_file():
                    sys.exit(f"other_tets: {measured / study / run}: this run did not finish")
                shutil.rmtree(both / study / run)
                shutil.copytree(measured / study / run, both / study / run)
        (both / "claims.json").unlink(missing_ok=True)
        subprocess.run([pbskin, "reproduce", "--judge", "-o", both], stdout=subprocess.DEVNULL, check=False)
        return json.loads((both / "claims.json").read_text(encoding="utf-8"))["claims"]


def values_on(claim):
    """The values of the cases on the human and the limb."""
    return [case["value"] for case in claim["cases"]
            if case.get("body") in WANTED_VERTICES and case["value"] is not None and not case["excluded"]]


def row_of(claim, size, vertices):
    cases = [case for case in claim["cases"] if not case["excluded"]]
    values, unit = values_on(claim), claim["cases"][0]["unit"]
    held_out = claim["held_out"]["verdict"] if isinstance(claim["held_out"], dict) else ""
    return (claim["id"], f"{size:.2f}", vertices["human"], vertices["limb"], claim["verdict"], held_out,
            claim["measured"], len(cases), sum(case["holds"] for case in cases), f"{min(values):.4g}",
            f"{max(values):.4g}", unit)


def is_decided(claim):
    """Whether these runs measure this claim. C12b is about several sizes and is not measured again."""
    return claim["study"] in RUNS and claim["id"] != "C12b" and bool(values_on(claim))


def rows(pbskin, record, output):
    for size in sorted(SIZES):
        folder = output / f"{size:.2f}"
        vertices = measure(pbskin, record, size, folder)
        yield from (row_of(claim, size, vertices) for claim in judge(pbskin, record, folder / "runs")
                    if is_decided(claim))
    yield from (row_of(claim, 1.0, VERTICES_OF_RECORD) for claim in judge(pbskin, record, None) if is_decided(claim))


def main(pbskin, output):
    record = HERE / "full"
    lines = sorted(rows(pathlib.Path(pbskin).resolve(), record, pathlib.Path(output).resolve()))
    with (HERE / "other_tets.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(lines)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
