"""The pages of studies for readers, DIR/STUDY/STUDY.md, composed from the tables that the studies write.

    written, status = pages.write(results)   # of each study that has a page and records
"""
import importlib
import math
import pathlib
import pkgutil
import sys
import tomllib

import records
from records import kept, whole_file

listed = tomllib.loads(pathlib.Path(__file__).with_name("columns.toml").read_text(encoding="utf-8"))


def composers():
    """For each study that has a page, in order, the function of the study's folder that composes it: those of short.py,
    and `page` of the module of the study's name."""
    modules = {module.name: importlib.import_module(f"pages.{module.name}")
               for module in pkgutil.iter_modules(__path__)}
    return dict(sorted((modules.pop("short").composers | {study: module.page
                                                          for study, module in modules.items()}).items()))


def write(results):
    """Returns the pages that were written and the exit status. A study without records has no page. Missing tables of a
    study are named on stderr; so are damaged records and pages that cannot be written, whose status is 2."""
    try:
        opened = kept.opened(results)
    except records.RecordsMissing as error:
        print(f"pbskin: {error}", file=sys.stderr)
        return [], 2
    written, status = [], 0
    for study, compose in composers().items():
        if not (opened / study / "plan.json").is_file():
            continue
        file = results / study / f"{study}.md"
        try:
            text = compose(opened / study)
            with whole_file.beside(file) as part:
                part.write_text(text, encoding="utf-8")
            written.append(file)
        except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
            print(f"pbskin: page of {study}: {error}", file=sys.stderr)
            status = max(status, 2 * isinstance(error, (records.RecordsDamaged, whole_file.CannotBeWritten)))
    return written, status


def table(rows, columns, **functions):
    """A Markdown table. columns: a table of columns.toml, whose functions are given by their names, or the like:
    {heading: its text, or a function of the row}."""
    def cell(row, column, digits):
        if callable(column):
            return column(row)
        if not digits or row[column] == "":
            return str(row[column])
        value = float(row[column])
        return "\u2013" if math.isnan(value) else f"{value:{digits}}"

    shown = []  # heading, column or function, format
    for heading, text in (listed[columns] if isinstance(columns, str) else columns).items():
        if callable(text) or text.startswith("("):
            shown.append((heading, text if callable(text) else functions[text[1:-1]], ""))
            continue
        for column, _, digits in (word.partition(":") for word in text.split()):
            form = f".{digits}f" if digits.isdigit() else f".{digits[1:] or 3}g" if digits else ""
            shown.append((column if " " in text or "\n" in text else heading, column, form))
    lines = ["| " + " | ".join(heading for heading, *_ in shown) + " |", "|" + "---|" * len(shown)]
    return "\n".join([*lines, *("| " + " | ".join(cell(row, *of) for _, *of in shown) + " |" for row in rows)]) + "\n"


def files(folder, name):
    """The file of each run that has it, in the order of the plan."""
    runs = [run["name"] for run in records.read_json(folder / "plan.json")["runs"]]
    return [folder / run / name for run in runs if (folder / run / name).is_file()]


def filled_files(folder, name):
    """Those of them that have a row."""
    return [file for file in files(folder, name) if records.read_rows(file)]


def of_runs(folder, name, needed):
    """The rows of a table of all runs, in the order of the plan. A run may have none, but not all of them."""
    filled = filled_files(folder, name)
    records.need(filled, f"{folder}: {name}: no rows in any run")
    return [row for file in filled for row in records.table(file, needed)]
