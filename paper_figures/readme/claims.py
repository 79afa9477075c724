"""Writes one line per claim of DIR/claims.json into README.md, between its markers: verdict, key number and the page of the claim.
sentences.py composes the texts, and DIR/claims.json holds every value behind a line.
"""
import records
from records import shapes
from words import sentences

columns = ("claim", "verdict", "values within the bound; the one farthest beyond it, or else nearest to it [interval], expected", "page")
pages = "experiments/verdicts/claims"


def line(*cells):
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\u2212", "-") for cell in cells) + " |"


def table_lines(results):
    """The lines of the table, the header first."""
    file = results / "claims.json"
    if not file.is_file():
        raise records.RecordsMissing(f"{file.name}: does not exist: `pbskin reproduce --judge` writes it next to the records")
    return [line(*columns), "|---" * len(columns) + "|", *map(row_of, sentences.claims_of(file))]


def row_of(claim):
    return line(f"{claim['statement']} ({claim['place']})", sentences.names[claim["verdict"]], sentences.key_number(claim),
                f"[{claim['id']}]({pages}/{claim['id']}.md)")


def revisions(results):
    """Each revision and the studies that were run at it; the revision with the most studies comes first."""
    studies = {}
    for file in sorted(results.glob("*/*/run.json")):
        facts = shapes.read(file, shapes.run).get("provenance", {})
        revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
        studies.setdefault(revision, {})[file.parent.parent.name] = True
    if not studies:
        raise records.RecordsMissing(f"{results}: no run.json of a study's run in it")
    most, *others = sorted(studies, key=lambda revision: -len(studies[revision]))
    return [most] + [f"{revision} ({', '.join(studies[revision])})" for revision in others]


def lines_of(results):
    return [*table_lines(results), "", f"Measured at revision {', '.join(revisions(results))}."]
