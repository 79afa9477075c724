"""Which sections C04 and C05 are judged by, which are left out and why, and where a pose changes the number of self-intersections."""
import pages
import records


def of_sections(rows):
    sections, remarks = {}, ""
    for row in rows:
        of = f"{row['body']} {row['pose']} {row['joint']}"
        sections.setdefault((row["claim"], row["outcome"]), []).append(of)
        if row["remark"]:
            remarks += f"- {row['claim']}: {of}, {row['outcome']}: {row['remark']}\n"
    text = "".join(f"- {claim}: {len(of)} sections {outcome}" + ("\n" if outcome == "measured" else f": {'; '.join(of)}\n")
                   for (claim, outcome), of in sorted(sections.items()))
    return text + ("\n## Remarks\n\n" + remarks if remarks else "")


def page(folder):
    sections = pages.of_runs(folder, "sections.csv", {"claim", "body", "pose", "joint", "outcome", "remark"})
    columns = {"pose", "surface", "deformer", "pairs", "pairs_at_rest"}
    crossings = [row | {"run": file.parent.name} for file in pages.files(folder, "intersections.csv")
                 for row in records.table(file, columns) if row["pairs"] != row["pairs_at_rest"]]
    return ("# The artefacts of blending\n\n## Sections\n\n" + of_sections(sections)
            + "\n## Where a pose changes the number of pairs of triangles that intersect\n\n" + pages.table(crossings, {
                "case": "run", "pose": "pose", "surface": "surface", "deformer": "deformer", "pairs": "pairs",
                "at rest": "pairs_at_rest"}))
