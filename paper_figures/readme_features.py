"""Copies the human's rows of DIR/features/features.csv into README.md, between its markers. Nobody types that table.

    python3 paper_figures/readme_features.py results/features
"""
import pathlib
import sys

import records

begin, end = "<!-- features:begin -->", "<!-- features:end -->"
head = ["| feature | ms of processor a frame without | with | ratio [quartiles] | start [s] without | with | peak [MB] without | with "
        "| the answer moves |", "|---|---|---|---|---|---|---|---|---|"]


def line(row):
    def pair(column, digits):
        return " | ".join(f"{float(row[column + side]):.{digits}f}" for side in ("_without", "_with"))

    ratio = " ".join([f"{float(row['frame_cpu_ms_ratio']):.2f}",
                      f"[{float(row['frame_cpu_ms_ratio_lower']):.2f}, {float(row['frame_cpu_ms_ratio_upper']):.2f}]"])
    moves = f"{1e3 * float(row['largest_distance_m']):.2g} mm" if row["largest_distance_m"] else ""
    return f"| {row['feature']} | {pair('frame_cpu_ms', 2)} | {ratio} | {pair('start_s', 2)} | {pair('peak_mb', 0)} | {moves} |"


def main(results, readme):
    folder = results / "features" / "human"
    try:
        table = head + [line(row) for row in records.table(folder / "features.csv", {"feature", "frame_cpu_ms_ratio"})]
        facts = records.provenance(results)
    except records.RecordsMissing as error:
        sys.exit(f"readme_features: {error}")
    before, rest = readme.read_text().split(begin)
    revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
    text = "\n".join(table)
    readme.write_text(f"{before}{begin}\n{text}\n\nMeasured at revision {revision}.\n{end}{rest.split(end)[1]}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(__file__).resolve().parent.parent / "README.md")
