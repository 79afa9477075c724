"""Kept records (experiments/records/full) have one table per study and kind in place of a folder per run. `opened` gives them the form of a
folder of results again.

    results = kept.opened(pathlib.Path(arguments[1]))

provenance.json: {"origins": [{"schema", "provenance", "runs": ["STUDY/RUN", ...], "tables": ["STUDY/curves.csv", ...]}]}, where `tables`
names tables that were measured apart from their runs, or is missing. plans.json: {STUDY: plan}. Tables of this folder begin with a column
`study`, and STUDY/runs/NAME.csv is NAME.csv of all runs with a column `run` in front. Everything else is as the study wrote it.
"""
import atexit
import json
import pathlib
import shutil
import tempfile

import records

apart = "measured_apart.json"  # in the opened folder: {pattern of tables: their provenance}


def opened(folder):
    """The folder itself; for kept records a temporary one, which has them as `pbskin reproduce` writes them."""
    if not (folder / "provenance.json").is_file():
        return folder
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="pbskin_kept_"))
    atexit.register(shutil.rmtree, scratch, ignore_errors=True)
    expand(folder, scratch)
    return scratch


def measured_apart(results):
    """{table: provenance} of the tables that were measured apart from the runs of their study."""
    listed = records.read_json(results / apart) if (results / apart).is_file() else {}
    return {file: provenance for pattern, provenance in listed.items() for file in sorted(results.glob(pattern))}


def expand(kept, into):
    """Writes each run's own files below `into`."""
    def write(text, source, *names):
        for name in map(pathlib.PurePath, names):
            records.need(not name.is_absolute() and ".." not in name.parts, f"{source}: {name}: expected no leading / and no .. in a name")
        file = into.joinpath(*names)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    plans, provenance, tables = kept / "plans.json", kept / "provenance.json", {}
    for study, plan in records.read_json(plans).items():
        write(json.dumps(plan, indent=2) + "\n", plans, study, "plan.json")
    try:
        for origin in records.read_json(provenance)["origins"]:
            for run in origin["runs"]:
                record = {"schema": origin["schema"], "provenance": origin["provenance"]}
                write(json.dumps(record, indent=1) + "\n", provenance, run, "run.json")
            tables |= {table.replace("/runs/", "/*/"): origin["provenance"] for table in origin.get("tables", [])}
    except (AttributeError, KeyError, TypeError):
        raise records.RecordsMissing(f"{provenance}: not as experiments/records/keep.py writes it") from None
    if tables:
        write(json.dumps(tables, indent=1) + "\n", provenance, apart)
    for file in sorted(kept.rglob("*")):
        place = file.relative_to(kept)
        if file.parent.name == "runs" or (file.parent == kept and file.suffix == ".csv"):
            study = "" if file.parent == kept else place.parts[0]
            for folder, lines in by_first_column(file).items():
                write(lines, file, study, folder, file.name)
        elif file.is_file() and file not in (plans, provenance):
            (into / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, into / place)


def by_first_column(file):
    """The table without its first column, for each value of it. A row without cells states that the table has no rows."""
    try:
        lines = [line.partition(",") for line in file.read_text(encoding="utf-8").splitlines(keepends=True)]
    except UnicodeDecodeError as error:
        raise records.RecordsMissing(f"{file}: not a table: {error}") from None
    for number, (value, comma, _) in enumerate(lines, 1):
        records.need(value and comma, f"{file}:{number}: {value.strip()}: expected a name and the cells of a row")
    records.need(lines, f"{file}: no rows")
    (_, _, head), *rows = lines
    tables = {}
    for value, _, line in rows:
        tables[value] = tables.get(value, head) + (line if line.strip(",\n") else "")
    return tables
