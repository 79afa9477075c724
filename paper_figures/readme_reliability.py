"""Copies what the tests of reliability counted, DIR/*.json, into README.md, between its markers. Nobody types that table.

    PBS_RELIABILITY_DIR=DIR ./check --long      # each test writes DIR/NAME.json: name, count, of, command, revision
    python3 paper_figures/readme_reliability.py DIR
"""
import json
import pathlib
import sys

begin, end = "<!-- reliability:begin -->", "<!-- reliability:end -->"
fields = ("name", "count", "of", "command", "revision")


def read(path):
    try:
        record = json.loads(path.read_text())
    except ValueError as error:
        sys.exit(f"readme_reliability: {path}: not JSON: {error}")
    for field in fields:
        if field not in record:
            sys.exit(f"readme_reliability: {path}: {field} =: expected all of {', '.join(fields)}")
    return record


def line(record):
    of = f" of {record['of']}"
    note = f" ({record['note']})" if record.get("note") else ""
    return f"| {record['name']} | {record['count']}{of}{note} | `{record['command']}` | {record['revision'][:12]} |"


def main(folder, readme):
    records = [read(path) for path in sorted(folder.glob("*.json"))]
    if not records:
        sys.exit(f"readme_reliability: {folder}: no record of a test")
    table = ["| what | measured | by | revision |", "|---|---|---|---|"] + [line(record) for record in records]
    before, rest = readme.read_text().split(begin)
    text = "\n".join(table)
    readme.write_text(f"{before}{begin}\n{text}\n{end}{rest.split(end)[1]}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(__file__).resolve().parent.parent / "README.md")
