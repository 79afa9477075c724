"""Copies the table of DIR/claims.md into README.md, between its markers. Nobody types that table.

    python3 paper_figures/readme_claims.py results/reproduce
"""
import pathlib
import sys

import claims_table
import records

begin, end = "<!-- claims:begin -->", "<!-- claims:end -->"


def revisions(results):
    """Each revision and the studies that were run at it, most studies first."""
    studies = {}
    for file in sorted(results.glob("*/*/run.json")):
        facts = records.read_json(file).get("provenance", {})
        revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
        studies.setdefault(revision, {})[file.parent.parent.name] = True
    if not studies:
        raise records.RecordsMissing(f"{results}: no run.json of a study's run in it")
    most, *others = sorted(studies, key=lambda revision: -len(studies[revision]))
    return [most] + [f"{revision} ({', '.join(studies[revision])})" for revision in others]


def main(results, readme):
    try:
        table = "\n".join(claims_table.table_lines(results))
        measured = ", ".join(revisions(results))
    except records.RecordsMissing as error:
        sys.exit(f"readme_claims: {error}")
    text = readme.read_text()
    before, rest = text.split(begin)
    after = rest.split(end)[1]
    readme.write_text(f"{before}{begin}\n{table}\n\nMeasured at revision {measured}.\n{end}{after}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(__file__).resolve().parent.parent / "README.md")
