"""How far the deformers are from nonlinear finite elements over whole sweeps and clips, from frame_statistics.csv."""
from report.markup import element, escaped, figure, folder_link, span, table
from report.record_set import not_run, number

shown = (("lbs", "LBS"), ("dqs", "DQS"), ("pbs", "PBS, 24 iterations"), ("snh_p1", "neo-Hookean FEM, P1"))


def reference_of(run):
    """Its name, model and element order, where it is a nonlinear one."""
    scene = run.get("scene", {})
    name = scene.get("reference", {}).get("name")
    fem = next((fem for fem in scene.get("fem", []) if fem["name"] == name), None)
    return fem if fem and fem["model"] != "linear" else None


def error_of(rows, deformer):
    """Median and range over the frames, as recorded."""
    chosen = [row for row in rows if row["deformer"] == deformer and row["variant"] in ("", "default") and row["iterations"] in ("", "24")]
    if not chosen or number(chosen[0], "error_joint_median_pct") is None:
        return "\u2013"
    least, median, most = (number(chosen[0], f"error_joint_{share}_pct") for share in ("least", "median", "most"))
    return f"{figure(median)} ({span([round(least, 3), round(most, 3)])})"


def row_of(found, name, fem):
    rows = found.rows(f"{name}/frame_statistics.csv")
    cells = ["\u2013" if deformer == fem["name"] else error_of(rows, deformer) for deformer, _ in shown]
    outcome = found.runs[name]["outcome"]
    meets = outcome.get("self_intersecting_reference_frames", 0)
    model = f"{fem['model'].replace('_', ' ')}, P{fem['element_order']}"
    return [folder_link(found.results, name), escaped(model), *cells, f"{meets} of {outcome['frames']}"]


def section(found):
    runs = [(name, reference_of(run)) for name, run in found.runs.items() if name.startswith("volume/")]
    rows = [row_of(found, name, fem) for name, fem in runs if fem and found.rows(f"{name}/frame_statistics.csv")]
    if not rows:
        return element("p", f"The distance over whole sweeps and clips is {not_run(found, 'volume')}.", class_="missing")
    header = ["run", "reference", *(label for _, label in shown), "frames in which the reference meets itself"]
    return table("Error at the joints [% of the mean distance to the bone]: median over the frames (least to most)", header, rows)
