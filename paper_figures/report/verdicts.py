"""The claims with their verdicts: the name of each verdict, the same on the whole page, with its symbol and the class of its colour; the
values behind it; and the table of all claims."""
from report.markup import Markup, beside_the_page, details, element, escaped, folder_link, items, joined, table
from words import case_words, sentences
from words.number_words import counted, figure, span_of_thousandths
from words.sentences import with_interval, with_unit

marks = {"reproduced": ("\u2714", "holds"), "reproduced_only_for": ("\u25d0", "partly"), "not_reproduced": ("\u2718", "fails"),
         "inconsistent_in_print": ("\u2260", "print"), "cannot_be_tested_here": ("\u25cb", "untested"), "not_computable": ("?", "fails")}


def mark_of(verdict):
    """(symbol, class, name)"""
    return (*marks[verdict], sentences.names[verdict])


def be(count):
    return "is" if count == 1 else "are"


# The data behind a verdict: the values of every run with their intervals, and the folder of its records.

holds = {"whole": "\u2714 yes", "part": "\u25d0 in part", "none": "\u2718 no"}
most_rows = 400  # rows per table; claims.json has the rest


def worst(case):
    def place(frame):
        return f"{figure(frame['angle_deg'])}\u00b0" if frame["angle_deg"] is not None else f"{figure(frame['time_s'])} s"

    return ", ".join(f"{figure(frame['value'])} at {place(frame)}" for frame in case["deepest"]) or "\u2013"


def run_table(claim, name, values, found):
    def row(case):
        deformer = case_words.of_field("deformer", case["deformer"]) + (f" ({case['variant']})" if "variant" in case else "")
        return [folder_link(found.results, case["run"]), deformer, sentences.title(claim, case["quantity"]), with_interval(case["mean"]),
                with_interval(case["share_of_frames"], 100), span_of_thousandths([case["least"], case["most"]]),
                holds[case["holds"]], worst(case), case["holding_with_inverted_tets"]]

    header = ["run", "deformer", "quantity", "mean [%]", "frames within the bound [%]", "range [%]", "holds", "worst frames",
              "frames within the bound with inverted tets"]
    rows = [row(case) for case in values if "frames" in case]
    return table(name, header, rows, "tall") if rows else ""


def value_table(claim, name, values, found):
    values = [value for value in values if "frames" not in value and "run" in value]
    if not values:
        return ""
    judged = any("holds" in value for value in values)

    def row(value):
        ends = "" if value["low"] == value["high"] else f"{figure(value['low'])} to {figure(value['high'])}"
        limit = case_words.tables["limit"].get(value.get("limit"), "")
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
    rows = [[sentences.reading_name(reading), sentences.names[reading["verdict"]], "yes" if reading["same"] else "no",
             ", ".join(sentences.differing(claim, reading))] for reading in claim["readings"]]
    return table(f"{claim['id']}: in other orders of projection", header, rows) if rows else ""


def behind(claim, found):
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


# The verdicts: counts, short texts, and a table whose rows open to the runs behind them. sentences.py composes the sentences.

columns = ("claim", "statement", "verdict", "expected", "measured", "for whom")


def mark(verdict):
    symbol, colour, name = mark_of(verdict)
    return Markup(f'<span class="mark {colour}"><span aria-hidden="true">{symbol}</span> {escaped(name)}</span>')


def counts_sentence(claims):
    """There are 17 claims: 3 are reproduced, 8 are reproduced in part, ..."""
    counts = {sentences.names[verdict]: sum(claim["verdict"] == verdict for claim in claims) for verdict in marks}
    words = [f"{count} {name if name.startswith('cannot') else f'{be(count)} {name}'}" for name, count in counts.items() if count]
    return f"There {be(len(claims))} {counted(len(claims), 'claim')}: {', '.join(words)}."


def chips(claims):
    """A mark for each claim, which links to its row."""
    def chip(claim):
        symbol, colour, name = mark_of(claim["verdict"])
        return Markup(f'<a class="chip {colour}" href="#{escaped(claim["id"])}" title="{escaped(claim["statement"])}">'
                      f'<span aria-hidden="true">{symbol}</span> {escaped(claim["id"])}'
                      f'<span class="unseen">: {escaped(name)}</span></a>')

    return element("p", joined(map(chip, claims), " "), class_="chips")


def measured(claim):
    """The claim's own values: every run, or the range of every quantity, with intervals in brackets."""
    runs = sentences.own_runs(claim)
    if runs:
        sweeps, clips = ([sentences.run_text(claim, case) for case in runs if case["sweep"] == swept] for swept in (True, False))
        what = "share of frames within the bound" if sentences.is_by_share(claim) else "mean"
        return items([*sweeps, *([f"Clips, with the {what} in % [95 % interval]:"] if clips else []), *clips], "plain")
    if not claim["n"]:
        return "\u2013"
    if claim["rule"] == "printed":
        return sentences.within(claim)
    groups = sentences.grouped(claim, claim["cases"], claim["each"])
    ranges = [f"{name}: {sentences.range_with_intervals(values)}" for name, values in groups.items()]
    return joined([sentences.within(claim), items(ranges, "plain")])


def expected(claim):
    texts = [text.replace("-", "\u2212") if claim["expected"] is not None else text for text in sentences.expected(claim)]
    return items(texts, "plain") if len(texts) > 1 else "".join(texts) or "\u2013"


def row(claim, pose):
    """pose: the link to it in the viewer, or None."""
    name = element("a", claim["id"], href=f"#{claim['id']}")
    statement = joined([claim["statement"], element("span", f" {claim['place']}", class_="place")]
                       + ([" ", element("a", "see it move", href=pose, class_="pose")] if pose else []))
    cells = [statement, mark(claim["verdict"]), expected(claim), measured(claim), sentences.outcome(claim)]
    named = joined(element("td", joined([element("span", column, class_="column"), cell]))  # on narrow screens, cells are stacked
                   for column, cell in zip(columns[1:], cells))
    return Markup(f'<tr id="{escaped(claim["id"])}" class="claim"><th scope="row">{name}</th>{named}</tr>')


def section(found, poses):
    if found.claims is None:
        return element("p", "claims.json is missing: `pbskin reproduce --judge -o DIR` judges the records", class_="missing")
    head = joined(element("th", name, scope="col") for name in columns)
    rows = [Markup(row(claim, poses.get(claim["id"])) + f'<tr class="behind"><td colspan="{len(columns)}">'
            f'{behind(claim, found)}</td></tr>') for claim in found.claims]
    table = Markup(f"<table class='claims'><caption>Each claim against the bound fixed beforehand</caption><thead><tr>{head}</tr></thead>"
                   "<tbody>\n" + joined(rows, "\n") + "</tbody></table>")
    return element("div", table, class_="scroll", tabindex=0, role="region", aria_label="Verdicts")
