"""The data behind a verdict: the values of every run with their intervals, and the folder of its records."""
from report.markup import beside_the_page, details, element, folder_link, items, joined, table
from report.verdict_names import name_of
from words import case_words, sentences
from words.number_words import counted, figure, span_of_thousandths
from words.sentences import with_interval, with_unit

holds = {"whole": "\u2714 yes", "part": "\u25d0 in part", "none": "\u2718 no"}
most_rows = 400  # rows per table; claims.json has the rest


def worst(case):
    def place(frame):
        return f"{figure(frame['angle_deg'])}\u00b0" if frame["angle_deg"] is not None else f"{figure(frame['time_s'])} s"

    return ", ".join(f"{figure(frame['value'])} at {place(frame)}" for frame in case["deepest"]) or "\u2013"


def run_row(claim, case, found):
    deformer = case_words.of_field("deformer", case["deformer"]) + (f" ({case['variant']})" if "variant" in case else "")
    return [folder_link(found.results, case["run"]), deformer, sentences.title(claim, case["quantity"]), with_interval(case["mean"]),
            with_interval(case["share_of_frames"], 100), span_of_thousandths([case["least"], case["most"]]),
            holds[case["holds"]], worst(case), str(case["holding_with_inverted_tets"])]


def run_table(claim, name, values, found):
    header = ["run", "deformer", "quantity", "mean [%]", "frames within the bound [%]", "range [%]", "holds", "worst frames",
              "frames within the bound with inverted tets"]
    rows = [run_row(claim, case, found) for case in values if "frames" in case]
    return table(name, header, rows, "tall") if rows else ""


def value_table(claim, name, values, found):
    values = [value for value in values if "frames" not in value and "run" in value]
    if not values:
        return ""
    judged = any("holds" in value for value in values)

    def row(value):
        ends = "" if value["low"] == value["high"] else f"{figure(value['low'])} to {figure(value['high'])}"
        limit = case_words.limits.get(value.get("limit"), "")
        return [case_words.of(value), sentences.title(claim, value["quantity"]), limit + figure(value["value"]) + with_unit(value["unit"]),
                ends or "\u2013", *([holds.get(value.get("holds"), "")] if judged else []), folder_link(found.results, value["run"])]

    header = ["of", "quantity", "value", "interval", *(["within the bound"] if judged else []), "run"]
    shown = table(name, header, [row(value) for value in values[:most_rows]], "tall")
    left = len(values) - most_rows
    return joined([shown, element("p", f"claims.json has {left} more.")]) if left > 0 else shown


def printed_table(claim):
    """The paper's own values compared with what its other values require."""
    rows = [[sentences.title(claim, value["quantity"]), case_words.of(value), figure(value["value"]),
             sentences.bound(value["bound_low"], value["bound_high"])] for value in claim["cases"] if "bound_low" in value]
    return table(f"{claim['id']}: values in print", ["quantity", "of", "printed", "the others require"], rows, "tall") if rows else ""


def orders_table(claim):
    header = ["order, precision", "verdict", "as the claim's own", "differing"]
    rows = [[sentences.reading_name(reading), name_of(reading["verdict"]), "yes" if reading["same"] else "no",
             ", ".join(sentences.differing(claim, reading))] for reading in claim["readings"]]
    return table(f"{claim['id']}: in other orders of projection", header, rows) if rows else ""


def of(claim, found):
    """A part that the reader opens: the verdict in full, the runs, the values."""
    parts = [items(sentences.verdict_in_full(claim), "verdict-text"),
             run_table(claim, f"{claim['id']}: runs", claim["cases"], found),
             run_table(claim, f"{claim['id']}: for comparison, no part of the verdict", claim["controls"], found),
             value_table(claim, f"{claim['id']}: values", claim["cases"], found),
             value_table(claim, f"{claim['id']}: for comparison, no part of the verdict", claim["controls"], found),
             printed_table(claim), orders_table(claim)]
    runs = joined((folder_link(found.results, run) for run in claim["runs"] or [claim["study"]]), ", ")
    parts.append(element("p", joined(["Runs (", beside_the_page("folders"), "): ", runs])))
    count = f" ({counted(len(claim['runs']), 'run')})" if claim["runs"] else ""
    return details(f"{claim['id']}: the data behind it{count}", joined(parts, "\n"))
