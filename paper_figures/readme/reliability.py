"""Copies the counts of the reliability tests, DIR/*.json, into the table of tests/README.md, between its markers.
"""
import records
from readme import part
from records import shapes


page = part.source / "tests" / "README.md"


def line(record):
    of = f" of {record['of']}"
    note = f" ({record['note']})" if record.get("note") else ""
    return f"| {record['name']} | {record['count']}{of}{note} | `{record['command']}` | {record['revision'][:12]} |"


def lines_of(folder):
    files = sorted(folder.glob("*.json"))
    if not files:
        raise records.RecordsMissing(f"{folder}: no record of a test")
    told = [shapes.read(file, shapes.reliability) for file in files]
    return ["| what | measured | by | revision |", "|---|---|---|---|", *map(line, told)]
