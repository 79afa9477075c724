"""The distance of the deformers from nonlinear finite elements over whole sweeps and clips, from frame_statistics.csv."""
import records
from records import shapes
from report.markup import beside_the_page, element, escaped, folder_link, items, joined, table
from report.record_set import not_run, number
from words import looks
from words.number_words import figure, span_of_thousandths

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
