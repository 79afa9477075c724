"""The table of claims.md, as rows of Markdown cells."""
import re

import records


def table_lines(results):
    return lines_of_first_table(results / "claims.md")


def lines_of_first_table(file):
    """Header first."""
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: not there")
    lines = file.read_text().splitlines()
    start = next((number for number, line in enumerate(lines) if line.lstrip().startswith("|")), None)
    if start is None:
        raise records.RecordsMissing(f"{file}: no table")
    table = []
    for line in lines[start:]:
        if not line.lstrip().startswith("|"):
            break
        table.append(line)
    return table


def cells(line):
    """The cells of a row; a bar inside one is written \\|."""
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
