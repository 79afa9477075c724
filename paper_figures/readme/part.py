"""Writes the parts of README.md and of other pages that scripts compose from records, each between two markers of its
own.

    status = part.main("claims", pages_of, results)  # pages_of(results): the lines between the markers, for each page
"""
import pathlib
import sys

import records
from records import whole_file

source = pathlib.Path(__file__).resolve().parents[2]
own_readme = source / "README.md"


def markers(name):
    return f"<!-- {name}:begin -->", f"<!-- {name}:end -->"


def cut(readme, name):
    """The text of the page up to and including the first marker, the part between the two, and the rest from the second
    marker."""
    try:
        text = readme.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise records.RecordsMissing(f"{readme}: cannot be read: {error}") from None
    begin, end = markers(name)
    for marker in (begin, end):
        if text.count(marker) != 1:
            raise records.RecordsMissing(f"{readme}: {marker} occurs {text.count(marker)} times: expected once")
    if text.index(end) < text.index(begin):
        raise records.RecordsMissing(f"{readme}: {end} precedes {begin}: expected after it")
    first, last = text.index(begin) + len(begin), text.index(end)
    return text[:first], text[first:last], text[last:]


def write(readme, name, lines):
    before, _, after = cut(readme, name)
    with whole_file.beside(readme) as path:
        path.write_text("\n".join([before, *lines, after]), encoding="utf-8")


def main(name, pages_of, results):
    """Writes the part NAME of each page, pages_of(results): {page: lines}. Returns the exit status: 2 if the records or
    a page are not as expected; that page stays as it was."""
    try:
        for page, lines in pages_of(results).items():
            write(page, name, lines)
    except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
        print(f"make_readme: {name}: {error}", file=sys.stderr)
        return 2
    return 0
