"""Captions with the figure's own numbers in them. In figures.toml {name} asks for one; facts(rows) of the figure's script tells it, of the
rows of NAME.csv; {cpu} is the processor of the runs behind it. The whole caption is written when the figure is drawn, to
NAME.caption.txt, and names at its end what was planned and is not on record.

    captions.write(entry, results, figures)
    captions.read(entry, figures)
"""
import importlib
import string

import records
import whole_file

of_runs = {"cpu"}  # told without the rows behind the figure


def asked(entry):
    """The numbers that its caption asks for."""
    return {name for _, name, _, _ in string.Formatter().parse(entry.caption) if name is not None}


def file_of(entry, figures):
    return figures / f"{entry.name}.caption.txt"


def whole(entry, figures, origin):
    told = {"cpu": origin.get("cpu_model", "a processor that is not on record")}
    if asked(entry) - of_runs:
        told |= importlib.import_module(entry.script).facts(records.table(figures / f"{entry.name}.csv", set()))
    return entry.caption.format_map(told) if asked(entry) else entry.caption


def not_on_record(names, planned):
    return f" Planned and not on record, {len(names)} of {planned}: {', '.join(names)}." if names else ""


def write(entry, results, figures):
    with whole_file.beside(file_of(entry, figures)) as path:
        path.write_text(whole(entry, figures, entry.origin(results)) + not_on_record(*entry.absent(results)) + "\n")


def read(entry, figures):
    """As it was when the figure was drawn; a caption without numbers needs no file."""
    file = file_of(entry, figures)
    if file.is_file():
        return file.read_text().rstrip("\n")
    if asked(entry):
        raise records.RecordsMissing(f"{file}: not there: draw the figure anew (paper_figures/make_all.py)")
    return entry.caption
