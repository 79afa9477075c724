"""The pages of studies for readers, DIR/STUDY/STUDY.md, composed from the tables that the studies write.

    written, status = pages.write(results)   # of each study that has a page and records
"""
import importlib
import math
import pkgutil
import sys

import records
from records import kept, whole_file

# Each module of this folder has page(folder) for the study of its name.
studies = sorted(module.name for module in pkgutil.iter_modules(__path__))


def write(results):
    """Returns the pages that were written and the exit status. A study without records has no page. Missing tables of a study are named on
    stderr; so are damaged records and pages that cannot be written, whose status is 2."""
    try:
        opened = kept.opened(results)
    except records.RecordsMissing as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return [], 2
    written, status = [], 0
    for study in studies:
        if not (opened / study / "plan.json").is_file():
            continue
        file = results / study / f"{study}.md"
        try:
            text = importlib.import_module(f"pages.{study}").page(opened / study)
            with whole_file.beside(file) as part:
                part.write_text(text, encoding="utf-8")
            written.append(file)
        except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
            print(f"pbskin: page of {study}: {error}", file=sys.stderr)
            status = max(status, 2 * isinstance(error, (records.RecordsDamaged, whole_file.CannotBeWritten)))
    return written, status


def table(rows, columns):
    """A Markdown table. columns: {heading: column, (column, decimals), (column, "g") with three digits or "g4" with four, or a function of
    the row}."""
    def cell(row, of):
        if callable(of):
            return of(row)
        name, decimals = of if isinstance(of, tuple) else (of, None)
        if decimals is None or row[name] == "":
            return row[name]
        value = float(row[name])
        digits = f".{decimals[1:] or 3}g" if isinstance(decimals, str) else f".{decimals}f"
        return "\u2013" if math.isnan(value) else f"{value:{digits}}"

    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join([*lines, *("| " + " | ".join(cell(row, of) for of in columns.values()) + " |" for row in rows)]) + "\n"


def own_names(text):
    """Columns under their own names, for table(): NAME, NAME:DECIMALS or NAME:g4."""
    parts = (word.partition(":") for word in text.split())
    return {name: (name, int(digits) if digits.isdigit() else digits) if digits else name for name, _, digits in parts}


def files(folder, name):
    """The file of each run that has it, in the order of the plan."""
    runs = [run["name"] for run in records.read_json(folder / "plan.json")["runs"]]
    return [folder / run / name for run in runs if (folder / run / name).is_file()]


def of_runs(folder, name, needed):
    """The rows of a table of all runs, in the order of the plan. A run may have none, but not all of them."""
    filled = [file for file in files(folder, name) if records.read_rows(file)]
    records.need(filled, f"{folder}: {name}: no rows in any run")
    return [row for file in filled for row in records.table(file, needed)]
