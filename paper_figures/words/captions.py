"""Captions that contain numbers of their figure. A name in braces in figures.toml is such a number: NAME_facts(rows) of the figure's script
computes it from the rows of NAME.csv, and {cpu} is the processor of the runs behind the figure. The whole caption is written to
NAME.caption.txt when the figure is drawn. Its end names the planned runs that have no record.

    captions.write(entry, results, figures)
    captions.read(entry, figures)
"""
import string

import records
from records import whole_file

of_runs = {"cpu"}  # known without the rows behind the figure


def asked(entry):
    """The names in braces in the entry's caption."""
    return {name for _, name, _, _ in string.Formatter().parse(entry.caption) if name is not None}


def file_of(entry, figures):
    return figures / f"{entry.name}.caption.txt"


def whole(entry, figures, origin):
    told = {"cpu": origin.get("cpu_model", "a processor that is not on record")}
    if asked(entry) - of_runs:
        told |= entry.facts(records.table(figures / f"{entry.name}.csv", set()))
    return entry.caption.format_map(told) if asked(entry) else entry.caption


def write(entry, results, figures):
    absent, planned = entry.absent(results)
    told = f" Planned runs without records, {len(absent)} of {planned}: {', '.join(absent)}." if absent else ""
    with whole_file.beside(file_of(entry, figures)) as path:
        path.write_text(whole(entry, figures, entry.origin(results)) + told + "\n")


def read(entry, figures):
    """The caption as it was when the figure was drawn; a caption without numbers needs no file."""
    file = file_of(entry, figures)
    if file.is_file():
        return file.read_text().rstrip("\n")
    if asked(entry):
        raise records.RecordsMissing(f"{file}: does not exist: draw the figure anew (paper_figures/make_all.py)")
    return entry.caption
