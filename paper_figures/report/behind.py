"""What a verdict rests on: every run's figures with their intervals, and where its records lie."""
from report.markup import beside_the_page, counted, details, element, figure, folder_link, items, joined, span_of_thousandths, table
from report.verdict_names import name_of

holds = {"whole": "\u2714 yes", "part": "\u25d0 in part", "none": "\u2718 no"}
most_rows = 400  # of one table; the rest stands in claims.json


def with_interval(interval, scale=1):
    if interval["estimate"] is None:
        return "\u2013"
    text = figure(scale * interval["estimate"])
    if None in (interval["low"], interval["high"]):
        return text
    return f"{text} [{figure(scale * interval['low'])}, {figure(scale * interval['high'])}]"


def worst(case):
    def place(frame):
        return f"{figure(frame['angle_deg'])}\u00b0" if frame["angle_deg"] is not None else f"{figure(frame['time_s'])} s"

    return ", ".join(f"{figure(frame['value'])} at {place(frame)}" for frame in case["deepest"]) or "\u2013"


def case_row(case, found):
    variant = "" if case["variant"] == "default" else f" ({case['variant']})"
    return [folder_link(found.results, case["run"]), case["deformer"] + variant, case["metric"], with_interval(case["mean"]),
            with_interval(case["share_of_frames"], 100), span_of_thousandths([case["least"], case["most"]]),
            holds[case["holds"]], worst(case), str(case["holding_with_inverted_tets"])]


def case_table(name, cases, found):
    header = ["run", "deformer", "measure", "mean [%]", "frames within [%]", "range [%]", "holds", "worst frames", "within though inverted"]
    return table(name, header, [case_row(case, found) for case in cases], "tall") if cases else ""


def measurement_table(name, measured, found):
    if not measured:
        return ""
    judged = any("holds" in entry for entry in measured)

    def row(entry):
        unit = "" if entry["unit"] == "1" else f" {entry['unit']}"
        ends = "" if entry["low"] == entry["high"] else f"{figure(entry['low'])} to {figure(entry['high'])}"
        return [entry["of"], entry["quantity"], figure(entry["value"]) + unit, ends or "\u2013",
                *([holds.get(entry.get("holds"), "")] if judged else []), folder_link(found.results, entry["run"])]

    header = ["of", "quantity", "value", "interval", *(["within"] if judged else []), "run"]
    shown = table(name, header, [row(entry) for entry in measured[:most_rows]], "tall")
    left = len(measured) - most_rows
    return joined([shown, element("p", f"and {left} more in claims.json")]) if left > 0 else shown


def printed_table(claim, found):
    """The paper's own figures against what its others ask for."""
    rows = [row for row in found.rows("audit/print/printed.csv") if row["claim"] == claim["id"]]
    header = ["figure", "printed", "the others ask for"]
    shown = [[row["what"], row["printed"], f"{row['least']} to {row['most']}" if row["most"] else f"{row['least']} or more"]
             for row in rows]
    return table(f"{claim['id']}: figures in print", header, shown, "tall") if rows else ""


def orders_table(claim):
    header = ["order, precision", "verdict", "as the claim's own", "differing"]
    rows = [[f"{other['order']}, {other['precision']}", name_of(other["verdict"]), "yes" if other["same"] else "no",
             ", ".join(other["differing"])] for other in claim["orders"]]
    return table(f"{claim['id']}: in other orders of projection", header, rows) if rows else ""


def of(claim, found):
    """To be opened: the verdict in whole, the runs, the figures."""
    parts = [items(claim["text"].replace("reproduced only for ", "reproduced in part: for ", 1).split("; "), "verdict-text"),
             case_table(f"{claim['id']}: cases", claim["cases"], found),
             case_table(f"{claim['id']}: beside them, no part of the verdict", claim["beside"], found),
             measurement_table(f"{claim['id']}: figures", claim["measurements"], found),
             measurement_table(f"{claim['id']}: beside them, no part of the verdict", claim["measured_beside"], found),
             printed_table(claim, found), orders_table(claim)]
    runs = joined((folder_link(found.results, run) for run in claim["runs"] or [claim["study"]]), ", ")
    parts.append(element("p", joined(["Runs (", beside_the_page("folders"), "): ", runs])))
    count = f" ({counted(len(claim['runs']), 'run')})" if claim["runs"] else ""
    return details(f"{claim['id']}: what is behind it{count}", joined(parts, "\n"))
