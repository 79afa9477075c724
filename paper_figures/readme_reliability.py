"""Copies the counts of the reliability tests, DIR/*.json, into the table of tests/README.md, between its markers.

    PBS_RELIABILITY_DIR=DIR ./check --long      # each test writes DIR/NAME.json: name, count, of, command, revision
    python3 paper_figures/readme_reliability.py DIR
"""
import sys

import readme_part
import record_shapes
import records


page = readme_part.source / "tests" / "README.md"


def line(record):
    of = f" of {record['of']}"
    note = f" ({record['note']})" if record.get("note") else ""
    return f"| {record['name']} | {record['count']}{of}{note} | `{record['command']}` | {record['revision'][:12]} |"


def lines_of(folder):
    files = sorted(folder.glob("*.json"))
    if not files:
        raise records.RecordsMissing(f"{folder}: no record of a test")
    told = [record_shapes.read(file, record_shapes.reliability) for file in files]
    return ["| what | measured | by | revision |", "|---|---|---|---|", *map(line, told)]


if __name__ == "__main__":
    sys.exit(readme_part.main("reliability", lines_of, sys.argv, __doc__, page))
