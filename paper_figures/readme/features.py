"""Copies the human's rows of DIR/timing/features_human/features.csv into the README of the study `timing`, so that nobody edits that table.
"""
import records
from readme import part
from words import case_words

page = part.source / "experiments" / "studies" / "timing" / "README.md"
head = ["| feature | processor ms per frame without | with | ratio [quartiles] | start [s] without | with | peak [MB] without | with "
        "| the result moves |", "|---|---|---|---|---|---|---|---|---|"]


def line(row):
    def pair(column, digits):
        return " | ".join(f"{float(row[column + side]):.{digits}f}" for side in ("_without", "_with"))

    ratio = " ".join([f"{float(row['frame_cpu_ms_ratio']):.2f}",
                      f"[{float(row['frame_cpu_ms_ratio_lower']):.2f}, {float(row['frame_cpu_ms_ratio_upper']):.2f}]"])
    moves = f"{1e3 * float(row['largest_distance_m']):.2g} mm" if row["largest_distance_m"] else ""
    name = case_words.of_field("feature", row["feature"])
    return f"| {name} | {pair('frame_cpu_ms', 2)} | {ratio} | {pair('start_s', 2)} | {pair('peak_mb', 0)} | {moves} |"


def lines_of(results):
    rows = records.table(results / "timing" / "features_human" / "features.csv", {"feature", "frame_cpu_ms_ratio"})
    facts = records.provenance(results / "timing" / "features_human")
    revision = facts.get("git_revision", "unknown")[:12] + (" with local changes" if facts.get("git_dirty") else "")
    return [*head, *map(line, rows), "", f"Measured at revision {revision}."]
