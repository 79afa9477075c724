"""Pages that are a few tables: a function of the study's folder returns their sections, each a heading, which may be
empty, and a text."""
import collections
import math

import pages
import records
from words import case_words


def of_sections(rows):
    """Which sections C04 and C05 are judged by, and which are excluded and why."""
    sections, remarks = {}, ""
    for row in rows:
        of = f"{row['body']} {row['pose']} {row['joint']}"
        sections.setdefault((row["claim"], row["outcome"]), []).append(of)
        if row["remark"]:
            remarks += f"- {row['claim']}: {of}, {row['outcome']}: {row['remark']}\n"
    text = "".join(f"- {claim}: {len(of)} sections {outcome}" + ("\n" if outcome == "measured"
                                                                 else f": {'; '.join(of)}\n")
                   for (claim, outcome), of in sorted(sections.items()))
    return text + ("\n## Remarks\n\n" + remarks if remarks else "")


def artefacts(folder):
    sections = pages.of_runs(folder, "sections.csv", {"claim", "body", "pose", "joint", "outcome", "remark"})
    columns = {"pose", "surface", "deformer", "pairs", "pairs_at_rest"}
    crossings = [row | {"case": file.parent.name} for file in pages.files(folder, "intersections.csv")
                 for row in records.table(file, columns) if row["pairs"] != row["pairs_at_rest"]]
    return [("Sections", of_sections(sections)),
            ("Where a pose changes the number of pairs of triangles that intersect",
             pages.table(crossings, "intersections"))]


def audit(folder):
    """What the paper prints, against what follows from its other numbers and equations."""
    rows = []
    for row in pages.of_runs(folder, "printed.csv", {"claim", "quantity", "printed", "least", "most"}):
        least, printed, most = float(row["least"]), float(row["printed"]), float(row["most"] or math.inf)
        of = case_words.of({name: row[name] for name in ("model", "equation", "gradient_of", "reading") if row[name]})
        bound = f"{least:.6g}" + (" or more" if most == math.inf else f" to {most:.6g}" if most != least else "")
        rows.append(row | {"of": of, "bound": bound, "consistent": "yes" if least <= printed <= most else "no"})
    return [("", pages.table(rows, "printed"))]


def convergence(folder):
    """One row per pose and initial guess, in the default order; of a ladder the LBS guess on each mesh."""
    found = [(file.parent.name, row) for file in pages.files(folder, "rates.csv")
             for row in records.table(file, {"start", "order", "precision", "own_mesh"})]
    kernels = {(row["order"], row["precision"]) for _, row in found}
    shown = ("ordered", "f32") if ("ordered", "f32") in kernels else ("plain", "f64")
    rows = [row for run, row in found if (row["order"], row["precision"]) == shown
            and (row["start"] == "lbs" if run.startswith("ladder") else row["own_mesh"] == "1")]
    return [("", pages.table(rows, "rates"))]


def of_jolts(folder):
    zone = records.table(folder / "zone.csv", {"share_of_vertices", "share_on_skin", "pieces", "bone", "share_of_zone"})
    text = (f"The zone is {100 * float(zone[0]['share_of_vertices']):.0f} % of the vertices, "
            f"{100 * float(zone[0]['share_on_skin']):.0f} % of it skin, in {zone[0]['pieces']} pieces: "
            + ", ".join(f"{row['bone']} {100 * float(row['share_of_zone']):.0f} %" for row in zone[:5]) + ".\n\n")
    return text + pages.table(records.table(folder / "responses.csv", {"deformer", "outcome", "frequency_hz"}),
                              "responses")


def jiggle(folder):
    """Each body's jiggling zone, its response to a jolt at each setting, and its response to the stop of a limb."""
    return ([(file.parent.name, of_jolts(file.parent)) for file in pages.files(folder, "responses.csv")]
            + [(file.parent.name, pages.table(records.table(file, {"deformer", "settling_s"}), "stop"))
               for file in pages.files(folder, "stop.csv")])


def counts(folder, name, keys):
    """A line for each group of rows with the same keys, in the order of their first rows: how many have each
    outcome."""
    lines = {}
    for row in pages.of_runs(folder, f"{name}.csv", {*keys, "outcome"}):
        group = {key: row[key] for key in keys}
        line = lines.setdefault(tuple(group.values()), collections.defaultdict(int, group))
        line[row["outcome"]] += 1
    return pages.table(lines.values(), name)


def stability(folder):
    cells = ("Cells", counts(folder, "cells", ("body", "model", "factor", "second_factor")))
    if not pages.filled_files(folder, "starts.csv"):  # those are of the full form
        return [cells]
    return [cells,
            ("Broken initial shapes", counts(folder, "starts", ("body", "model", "pose", "setting", "setting_value")))]


def temporal(folder):
    """Each deformer and initial guess along each clip, and in how many frames the frame before is a worse guess than
    the method's own."""
    def guess(row):
        worse = row["worse_than_cold_frames"]
        return (f"the frame before, worse in {worse} of {int(row['compared']) - 1}" if row["start"] == "frame_before"
                else "the method's own")
    return [(file.parent.name,
             pages.table(records.table(file, {"deformer", "start", "compared", "worse_than_cold_frames"}), "temporal",
                         guess=guess)) for file in pages.files(folder, "summary.csv")]


titles = {artefacts: "The artefacts of blending", audit: "The paper against itself",
          convergence: "Convergence from each initial guess", jiggle: "Jiggle", stability: "Stability",
          temporal: "Along a clip"}


def composer(sections):
    """The function of a study's folder that composes the page."""
    return lambda folder: f"# {titles[sections]}\n" + "".join(
        "\n" + (f"## {heading}\n\n" if heading else "") + text for heading, text in sections(folder))


composers = {sections.__name__: composer(sections) for sections in titles}
