"""One line per claim of DIR/claims.json into README.md, between its markers: what is expected, measured and found. Nobody types that table;
sentences.py composes it, and DIR/claims.json holds every value behind a line.

    python3 paper_figures/readme_claims.py results/reproduce
"""
import sys

import readme_part
import record_shapes
import records
import sentences

columns = ("id", "statement", "expected", "measured", "verdict")


def line(*cells):
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\u2212", "-") for cell in cells) + " |"


def table_lines(results):
    """Header first."""
    file = results / "claims.json"
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: not there: `pbskin reproduce --judge -o {results}` writes it")
    return [line(*columns), "|---" * len(columns) + "|", *map(row_of, sentences.claims_of(file))]


def row_of(claim):
    return line(claim["id"], f"{claim['statement']} ({claim['place']})", sentences.expected_in_line(claim),
                sentences.measured_in_line(claim), sentences.names[claim["verdict"]])


def revisions(results):
    """Each revision and the studies that were run at it, most studies first."""
    studies = {}
    for file in sorted(results.glob("*/*/run.json")):
        facts = record_shapes.read(file, record_shapes.run).get("provenance", {})
        revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
        studies.setdefault(revision, {})[file.parent.parent.name] = True
    if not studies:
        raise records.RecordsMissing(f"{results}: no run.json of a study's run in it")
    most, *others = sorted(studies, key=lambda revision: -len(studies[revision]))
    return [most] + [f"{revision} ({', '.join(studies[revision])})" for revision in others]


def lines_of(results):
    return [*table_lines(results), "", f"Measured at revision {', '.join(revisions(results))}."]


if __name__ == "__main__":
    sys.exit(readme_part.main("claims", lines_of, sys.argv, __doc__))
