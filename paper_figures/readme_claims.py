"""Copies the table of DIR/claims.md into README.md, between its markers. Nobody types that table.

    python3 paper_figures/readme_claims.py results/reproduce
"""
import pathlib
import sys

import claims_table
import records

begin, end = "<!-- claims:begin -->", "<!-- claims:end -->"


def main(results, readme):
    try:
        table = "\n".join(claims_table.table_lines(results))
        facts = records.provenance(results)
    except records.RecordsMissing as error:
        sys.exit(f"readme_claims: {error}")
    text = readme.read_text()
    before, rest = text.split(begin)
    after = rest.split(end)[1]
    revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
    readme.write_text(f"{before}{begin}\n{table}\n\nMeasured at revision {revision}.\n{end}{after}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(__file__).resolve().parent.parent / "README.md")
