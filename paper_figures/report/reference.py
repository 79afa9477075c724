"""The finite element reference's own verification, where that study is on record: its table, and the notes below it."""
import re

import claims_table
from report.markup import counted, element, inline, joined, table
from report.record_set import not_run


def verdict(header, rows):
    """Of the rows that have a bound, how many keep it."""
    held = [row[header.index("holds")].strip() for row in rows]
    bounded = [word for word in held if word]
    return (f"{bounded.count('yes')} of {counted(len(bounded), 'figure')} with a bound set beforehand keep it; "
            f"{len(held) - len(bounded)} more have none and are there to be seen.")


def section(found):
    file = found.results / "verification" / "verification.md"
    if not file.is_file():
        return element("p", f"The reference against theory and benchmarks is {not_run(found, 'verification')}.", class_="missing")
    header, _, *rows = [claims_table.cells(line) for line in claims_table.lines_of_first_table(file)]
    notes = [line.split(". ", 1)[1] for line in file.read_text().splitlines() if re.match(r"[0-9]+\. ", line)]
    shown = table("The reference against theory and published benchmarks", header, [[inline(cell) for cell in row] for row in rows], "tall")
    answer = element("p", verdict(header, rows), class_="answer")
    return joined([answer, shown, element("ol", joined(element("li", inline(note)) for note in notes)) if notes else ""])
