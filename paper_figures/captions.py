"""Captions with the figure's own numbers in them. In figures.toml {name} asks for one; facts(rows) of the figure's script tells it, of the
rows of NAME.csv. The whole caption is written when the figure is drawn: NAME.caption.txt.

    captions.write(entry, figures)
    captions.read(entry, figures)
"""
import importlib
import string

import records
import whole_file


def asked(entry):
    """The numbers that its caption asks for."""
    return {name for _, name, _, _ in string.Formatter().parse(entry.caption) if name is not None}


def file_of(entry, figures):
    return figures / f"{entry.name}.caption.txt"


def whole(entry, figures):
    if not asked(entry):
        return entry.caption
    rows = records.table(figures / f"{entry.name}.csv", set())
    return entry.caption.format_map(importlib.import_module(entry.script).facts(rows))


def write(entry, figures):
    with whole_file.beside(file_of(entry, figures)) as path:
        path.write_text(whole(entry, figures) + "\n")


def read(entry, figures):
    """As it was when the figure was drawn; a caption without numbers needs no file."""
    file = file_of(entry, figures)
    if file.is_file():
        return file.read_text().rstrip("\n")
    if asked(entry):
        raise records.RecordsMissing(f"{file}: not there: draw the figure anew (paper_figures/make_all.py)")
    return entry.caption
