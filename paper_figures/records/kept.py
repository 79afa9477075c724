"""Kept records (experiments/records/full) have one table per study and kind in place of a folder per run. `opened` gives them the form of a
folder of results again.

    results = kept.opened(pathlib.Path(arguments[1]))

provenance.json: {"origins": [{"schema", "provenance", "runs": ["STUDY/RUN", ...]}]}. plans.json: {STUDY: plan}. Tables of this folder begin
with a column `study`, and STUDY/runs/NAME.csv is NAME.csv of all runs with a column `run` in front. Everything else is as the study wrote
it.
"""
import atexit
import json
import pathlib
import shutil
import tempfile

import records


def opened(folder):
    """The folder itself; for kept records a temporary one, which has them as `pbskin reproduce` writes them."""
    if not (folder / "provenance.json").is_file():
        return folder
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="pbskin_kept_"))
    atexit.register(shutil.rmtree, scratch, ignore_errors=True)
    expand(folder, scratch)
    return scratch


def expand(kept, into):
    """Writes each run's own files below `into`."""
    def write(name, text):
        (into / name).parent.mkdir(parents=True, exist_ok=True)
        (into / name).write_text(text, encoding="utf-8")

    try:
        for study, plan in records.read_json(kept / "plans.json").items():
            write(f"{study}/plan.json", json.dumps(plan, indent=2) + "\n")
        for origin in records.read_json(kept / "provenance.json")["origins"]:
            for run in origin["runs"]:
                write(f"{run}/run.json", json.dumps({"schema": origin["schema"], "provenance": origin["provenance"]}, indent=1) + "\n")
    except (KeyError, TypeError):
        raise records.RecordsMissing(f"{kept / 'provenance.json'}: not as experiments/records/keep.py writes it") from None
    for file in sorted(kept.rglob("*")):
        place = file.relative_to(kept)
        if file.parent.name == "runs" or (file.parent == kept and file.suffix == ".csv"):
            study = "" if file.parent == kept else f"{place.parts[0]}/"
            for folder, lines in by_first_column(file).items():
                write(f"{study}{folder}/{file.name}", lines)
        elif file.is_file() and place.name not in ("plans.json", "provenance.json"):
            (into / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, into / place)


def by_first_column(file):
    """The table without its first column, for each value of it. A row without cells states that the table has no rows."""
    (_, head), *rows = (line.split(",", 1) for line in file.read_text(encoding="utf-8").splitlines(keepends=True))
    tables = {}
    for value, line in rows:
        tables[value] = tables.get(value, head) + (line if line.strip(",\n") else "")
    return tables
