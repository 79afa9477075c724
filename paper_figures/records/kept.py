"""Kept records (experiments/records/full) have one table per study and kind in place of a folder per run. `opened`
gives them the form of a folder of results again.

    results = kept.opened(pathlib.Path(arguments[1]))

provenance.json: {"origins": [{"schema", "provenance", "runs": ["STUDY/RUN", ...]}]}. plans.json: {STUDY: plan}. Tables
of this folder begin with a column `study`, and STUDY/runs/NAME.csv is NAME.csv of all runs with a column `run` in
front, or NAME.csv.gz where it is long. Everything else is as the study wrote it.
"""
import atexit
import gzip
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


def record_behind(results):
    """The folder of the kept record that judges these results, if they are a part of it: `pbskin reproduce` names it in
    repeated.json."""
    file = results / "repeated.json"
    first = records.read_json(file).get("first") if file.is_file() else None
    is_part = any(records.read_json(plan).get("extent") == "quick" for plan in results.glob("*/plan.json"))
    return (pathlib.Path(first) if is_part and isinstance(first, str)
            and (pathlib.Path(first) / "provenance.json").is_file() else None)


def expand(kept, into):
    """Writes each run's own files below `into`."""
    def write(text, source, *names):
        for name in map(pathlib.PurePath, names):
            records.need(not name.is_absolute() and ".." not in name.parts,
                         f"{source}: {name}: expected no leading / and no .. in a name")
        file = into.joinpath(*names)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    plans, provenance = kept / "plans.json", kept / "provenance.json"
    for study, plan in records.read_json(plans).items():
        write(json.dumps(plan), plans, study, "plan.json")
    try:
        for origin in records.read_json(provenance)["origins"]:
            for run in origin["runs"]:
                write(json.dumps({key: origin[key] for key in ("schema", "provenance")}) + "\n", provenance, run,
                      "run.json")
    except (AttributeError, KeyError, TypeError):
        raise records.RecordsMissing(f"{provenance}: not as experiments/records/keep.py writes it") from None
    for file in sorted(kept.rglob("*")):
        if file.parent.name == "runs" or (file.parent == kept and file.suffix == ".csv"):
            study = "" if file.parent == kept else file.relative_to(kept).parts[0]
            for folder, lines in by_first_column(file).items():
                write(lines, file, study, folder, file.name.removesuffix(".gz"))
        elif file.is_file() and file not in (plans, provenance):
            place = into / file.relative_to(kept)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, place)


def by_first_column(file):
    """The table without its first column, for each value of it. A row without cells states that the table has no
    rows."""
    tables, head = {}, None
    content = gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes()
    for number, text in enumerate(content.decode(errors="replace").splitlines(keepends=True), 1):
        value, comma, line = text.partition(",")
        records.need(value and comma, f"{file}:{number}: {value.strip()}: expected a name and the cells of a row")
        if head is not None:
            tables[value] = tables.get(value, head) + (line if line.strip(",\n") else "")
        head = head or line
    records.need(head, f"{file}: no rows")
    return tables
