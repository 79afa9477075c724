"""The distance of the deformers from nonlinear finite elements over whole sweeps and clips, from frame_statistics.csv;
and the verification of the finite element reference itself: its values, their sources and the origins of thresholds."""
import records
from records import shapes
from report.markup import beside_the_page, element, escaped, folder_link, inline, items, joined, table
from report.record_set import not_run, number
from words import case_words, looks
from words.number_words import counted, figure, span_of_thousandths

shown = tuple((name, looks.of(name).name) for name in ("lbs", "dqs", "pbs", "nh_p1"))


def reference_of(run):
    """Name, model and element order of the reference, if it is a nonlinear one."""
    scene = run.get("scene", {})
    name = scene.get("reference", {}).get("name")
    fem = next((fem for fem in scene.get("fem", []) if fem["name"] == name), None)
    return fem if fem and fem["model"] != "linear" else None


def error_of(folder, deformer):
    """Median and range over the frames, as recorded."""
    chosen = [row for row in records.frame_statistics(folder, deformer) if row["iterations"] in ("", "24")]
    if not chosen or number(chosen[0], "error_joint_median_pct") is None:
        return "\u2013"
    least, median, most = (number(chosen[0], f"error_joint_{share}_pct") for share in ("least", "median", "most"))
    return f"{figure(median)} ({span_of_thousandths([least, most])})"


def row_of(found, name, fem):
    outcome = found.run(name, shapes.judged_run)["outcome"]
    cells = ["\u2013" if deformer == fem["name"] else error_of(found.results / name, deformer) for deformer, _ in shown]
    overlaps = outcome.get("frames_with_overlap", 0)
    model = f"{fem['model'].replace('_', ' ')}, P{fem['element_order']}"
    return [folder_link(found.results, name), escaped(model), *cells, f"{overlaps} of {outcome['frames']}"]


def section(found):
    """The HTML of the table, and the runs that are missing in it."""
    runs = [(name, reference_of(run)) for name, run in found.runs.items() if name.startswith("volume/")]
    rows, missing = [], []
    for name, fem in runs:
        try:
            rows += [row_of(found, name, fem)] if fem else []
        except records.RecordsMissing as error:
            missing.append(str(error).replace(f"{found.results}/", ""))
    left_out = items(missing, "not-drawn") if missing else ""
    if not rows:
        reason = "not on record:" if missing else f"{not_run(found, 'volume')}."
        told = element("p", f"The distance over whole sweeps and clips is {reason}", class_="missing")
        return joined([told, left_out], "\n"), missing
    header = ["run", "reference", *(label for _, label in shown), "frames in which the reference overlaps itself"]
    caption = "Error at the joints [% of the mean distance to the bone]: median over the frames (least to most)"
    where = element("p", f"The runs are {beside_the_page('folders')}.", class_="lead")
    return joined([table(caption, header, rows), where, left_out], "\n"), missing


reference_header = ["problem", "quantity", "elements", "material", "mesh", "degrees of freedom", "value", "reference",
                    "unit", "difference [%]", "order (theory)", "threshold", "holds", "notes"]


def verdict(rows):
    """How many of the values with a threshold lie within it."""
    bounded = [row["holds"] for row in rows if row["holds"]]
    return (f"{bounded.count('yes')} of {counted(len(bounded), 'value')} with a threshold fixed beforehand lie "
            "within it; "
            f"{len(rows) - len(bounded)} more have no threshold and are reported only.")


def cells(row, notes):
    ends = [number(row, "low"), number(row, "high")]
    order = "" if number(row, "observed_order") is None else f"{number(row, 'observed_order'):.2f}"
    theory = (f" ({figure(number(row, 'expected_order'))})" if order and number(row, "expected_order") is not None
              else "")
    difference = number(row, "difference_pct")
    marks = [str(notes.index(row[column]) + 1) for column in ("source", "bound_from") if row[column]]
    return [row["problem"], inline(row["description"] + (f" ({row['note']})" if row["note"] else "")),
            case_words.elements(row["element_order"], row["formulation"]), case_words.material(row), row["mesh"],
            row["dofs"], figure(number(row, "value")), figure(number(row, "reference")), row["unit"],
            "" if difference is None else f"{difference:+.3g}".replace("-", "\u2212"), order + theory,
            "" if ends == [None, None] else f"{figure(ends[0])} to {figure(ends[1])}", row["holds"], ", ".join(marks)]


def reference_section(found):
    rows = found.rows("verification/verification.csv")
    if not rows:
        return element("p", f"The reference against theory and benchmarks is {not_run(found, 'verification')}.",
                       class_="missing")
    # Sources and origins of thresholds, each once, in the order of the rows.
    notes = list(dict.fromkeys(row[column] for row in rows for column in ("source", "bound_from") if row[column]))
    shown = table("The reference against theory and published benchmarks", reference_header,
                  [cells(row, notes) for row in rows], "tall")
    answer = element("p", verdict(rows), class_="answer")
    return joined([answer, shown, element("ol", joined(element("li", inline(note)) for note in notes)) if notes
                   else ""])
