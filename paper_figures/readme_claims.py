"""A line a claim of DIR/claims.json into README.md, between its markers: what is expected, measured and found. Nobody types that table; all
figures behind a line stand in DIR/claims.md.

    python3 paper_figures/readme_claims.py results/reproduce
"""
import sys

import readme_part
import record_shapes
import records
from report import verdicts
from report.markup import counted, span

columns = ("id", "statement", "expected", "measured", "verdict")
most_quantities = 3  # that are told one by one


def line(*cells):
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\u2212", "-") for cell in cells) + " |"


def measured(claim):
    """What its runs are judged by, or each bound's quantities from the least to the most; how much of it is as expected."""
    cases = claim["cases"] and verdicts.own_cases(claim)
    if cases:
        held = [sum(case["holds"] == how for case in cases) for how in ("whole", "part")]
        return "; ".join([*verdicts.sweeps_and_clips(claim), f"{held[0]} of {counted(len(cases), 'run')} within, {held[1]} in part"])
    bounds = claim["expected"].split("; ")
    if len(bounds) > most_quantities:
        return claim["measured"] + farthest(claim)
    names = [bound.rsplit(": ", 1)[0] for bound in bounds] if len(bounds) > 1 else [None]  # one bound: of all quantities
    ranges = [range_of([entry for entry in claim["measurements"] if name in (None, entry["quantity"])]) for name in names]
    return "; ".join(filter(None, [*ranges, claim["measured"]]))


def farthest(claim):
    told = verdicts.farthest(claim, of_quantity=True)
    if not told and claim["verdict"] != "reproduced":
        raise records.RecordsMissing(f"claim {claim['id']}: text = {claim['text']}: expected `; farthest: QUANTITY of CASE is VALUE` "
                                     "in it, for not all holds")
    return told


def range_of(entries):
    values = [entry["value"] for entry in entries if entry["value"] is not None]
    unit = "" if not values or entries[0]["unit"] == "1" else f" {entries[0]['unit']}"
    return span(values) + unit if values else ""


def expected(claim):
    bounds = claim["expected"].split("; ")
    return claim["expected"] if len(bounds) <= most_quantities else f"{len(bounds)} quantities, each within its bound"


def table_lines(results):
    """Header first."""
    file = results / "claims.json"
    if not file.is_file():
        raise records.RecordsMissing(f"{file}: not there: `pbskin reproduce --judge -o {results}` writes it")
    claims = record_shapes.read(file, record_shapes.claims)["claims"]
    try:
        rows = [row_of(claim) for claim in claims]
    except records.RecordsMissing as error:
        raise records.RecordsMissing(f"{file}: {error}") from None
    return [line(*columns), "|---" * len(columns) + "|", *rows]


def row_of(claim):
    verdict = claim["verdict"].removesuffix(" only for") + (" in part" if claim["verdict"].endswith(" only for") else "")
    return line(claim["id"], f"{claim['statement']} ({claim['place']})", expected(claim), measured(claim), verdict)


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
