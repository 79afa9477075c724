"""The finite element reference's own verification, where that study is on record: its table, and the notes below it."""
import re

import claims_table
from report.markup import element, inline, joined, table
from report.record_set import not_run


def section(found):
    file = found.results / "verification" / "verification.md"
    if not file.is_file():
        return element("p", f"The reference against theory and benchmarks is {not_run(found, 'verification')}.", class_="missing")
    header, _, *rows = [claims_table.cells(line) for line in claims_table.lines_of_first_table(file)]
    notes = [line.split(". ", 1)[1] for line in file.read_text().splitlines() if re.match(r"[0-9]+\. ", line)]
    shown = table("The reference against theory and published benchmarks", header, [[inline(cell) for cell in row] for row in rows], "tall")
    return joined([shown, element("ol", joined(element("li", inline(note)) for note in notes)) if notes else ""])
