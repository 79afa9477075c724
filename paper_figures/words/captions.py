"""The title of a figure, which is its message, and its caption. A name in braces in figures.toml is a number of the
figure: NAME_facts(rows) of the figure's script computes it from the rows of NAME.csv, and {cpu} is the processor of the
runs behind the figure. Both are written to NAME.title.txt and NAME.caption.txt when the figure is drawn. The caption's
end names the planned runs that have no record.

    captions.write(entry, results, figures)
    captions.read(entry, figures, "title")
"""
import string

import records
from records import whole_file

of_runs = {"cpu"}  # known without the rows behind the figure


def asked(entry, parts=("title", "caption")):
    """The names in braces."""
    return {name for part in parts for _, name, _, _ in string.Formatter().parse(getattr(entry, part))
            if name is not None}


def file_of(entry, figures, part):
    return figures / f"{entry.name}.{part}.txt"


def whole(entry, figures, origin, part="caption"):
    told = {"cpu": origin.get("cpu_model", "a processor that is not on record")}
    if asked(entry, [part]) - of_runs:
        told |= entry.facts(records.table(figures / f"{entry.name}.csv", set()))
    return getattr(entry, part).format_map(told) if asked(entry, [part]) else getattr(entry, part)


def write(entry, results, figures):
    absent, planned = entry.absent(results)
    told = f" Planned runs without records, {len(absent)} of {planned}: {', '.join(absent)}." if absent else ""
    for part, more in (("title", ""), ("caption", told)):
        with whole_file.beside(file_of(entry, figures, part)) as path:
            path.write_text(whole(entry, figures, entry.origin(results), part) + more + "\n")


def read(entry, figures, part="caption"):
    """The title or caption as it was when the figure was drawn; one without numbers needs no file."""
    file = file_of(entry, figures, part)
    if file.is_file():
        return file.read_text().rstrip("\n")
    if asked(entry, [part]):
        raise records.RecordsMissing(f"{file}: does not exist: draw the figure anew (paper_figures/make_all.py)")
    return getattr(entry, part)
