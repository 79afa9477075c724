"""The verdicts: counted, in short words, and as a table whose rows open to the runs behind them."""
import re

from report import behind
from report.markup import Markup, counted, element, escaped, figure, items, joined, span, span_of_thousandths
from report.verdict_names import counted_in_words, mark_of, name_of

columns = ("claim", "statement", "verdict", "expected", "measured", "for whom")


def mark(verdict):
    symbol, colour, name = mark_of(verdict)
    return Markup(f'<span class="mark {colour}"><span aria-hidden="true">{symbol}</span> {escaped(name)}</span>')


def counts_sentence(claims):
    """Of 17 claims 3 are reproduced, 8 are reproduced in part, ..."""
    return f"Of {counted(len(claims), 'claim')} {counted_in_words(claims)}."


def chips(claims):
    """A mark a claim, to its row."""
    def chip(claim):
        symbol, colour, name = mark_of(claim["verdict"])
        return Markup(f'<a class="chip {colour}" href="#{escaped(claim["id"])}" title="{escaped(claim["statement"])}">'
                      f'<span aria-hidden="true">{symbol}</span> {escaped(claim["id"])}'
                      f'<span class="unseen">: {escaped(name)}</span></a>')

    return element("p", joined(map(chip, claims), " "), class_="chips")


def own_cases(claim):
    """Those judged by the claim's own metric, which is the first."""
    return [case for case in claim["cases"] if case["metric"] == claim["cases"][0]["metric"]]


def is_sweep(case):
    return case["share_of_frames"]["low"] is None  # its frames are poses, no sample of a motion


spoken = {"limb_twist": "the limb twisted", "limb_bend": "the limb bent"}  # runs by what they show


def in_words(run):
    """A run's name: human_01_01 (jiggle) is the human in clip 01_01, with jiggling flesh."""
    if run in spoken:
        return spoken[run].removeprefix("the ")
    clip = re.fullmatch(r"([a-z]+)_(\d\d_\d\d)(?: \((.*)\))?", run)
    if not clip:
        return run
    body, number, variant = clip.groups()
    flesh = {"jiggle": ", jiggling flesh", None: ""}
    return f"{body}, clip {number}" + flesh.get(variant, f", {variant}")


def angles(case):
    """Where a sweep holds, of the angles that it has."""
    name = case["text"].split(":")[0]
    last = re.search(r" deg of ([0-9.]+)", case["text"])
    held = ", ".join(f"{figure(low)} to {figure(high)}" for low, high in case["angles_deg"])
    whole = f" of {last[1]}" if last else ""
    return f"{spoken.get(name, name)} " + (f"by {held}{whole}\u00b0" if held else "by no angle")


def outcome(claim, in_short=False):
    """For whom it holds, in a line; in short: without whose the farthest figure is."""
    cases = own_cases(claim)
    if not cases:
        return words_of(claim, in_short)
    clips = [case for case in cases if not is_sweep(case)]
    parts = ["for " + ", ".join(angles(case) for case in cases if is_sweep(case))] if len(clips) < len(cases) else []
    if clips:
        held = sum(case["holds"] == "whole" for case in clips)
        parts.append(f"for {held} of {counted(len(clips), 'clip')} ({clip_figures(claim, clips)})")
    return "; ".join(parts)


def words_of(claim, in_short=False):
    """The verdict's text without the verdict and without single figures."""
    words = claim["text"].removeprefix(claim["verdict"]).lstrip(": ").split("; farthest")[0].split("; beside it")[0]
    before = {"reproduced": "for ", "reproduced only for": "for ", "not reproduced": "not for "}
    if claim["verdict"] == "inconsistent in print":
        return f"{claim['measured']} with the paper\u2019s others"
    if claim["verdict"] == "not reproduced":
        words += farthest(claim, of_quantity=in_short, named=changes_in_words if in_short else str)
    return before.get(claim["verdict"], "") + words


changes = {"half the time step": "the time step is halved", "twice the iterations": "the iterations are doubled",
           "twice the resolution": "the resolution is doubled"}


def changes_in_words(quantity):
    """Of a figure of one run over that of another, what was changed between them."""
    ratio = re.fullmatch(rf"(.*) at ({'|'.join(changes)}) over at the (?:whole|once)", quantity)
    return f"factor on the {ratio[1]} when {changes[ratio[2]]}" if ratio else quantity


def beside(claim, most=4):
    """The first quantities that were measured beside, without a bound, from the least to the most; "": none."""
    rows = {}
    for row in claim["measured_beside"]:
        rows.setdefault((row["quantity"], row["unit"]), []).append(row)
    return ", ".join([told_beside(quantity, unit, found) for (quantity, unit), found in rows.items()][:most])


trials = {"share of cells inverted": "end with inverted tets", "share of cells not at rest": "end in motion",
          "share of cells converged": "end as if undisturbed"}


def told_beside(quantity, unit, rows):
    """Shares of trials as counts over all of them, where each row tells of how many it is."""
    values = [row["value"] for row in rows]
    counts = [re.search(r", n = ([0-9]+)$", row["of"]) for row in rows]
    if quantity in trials and all(counts) and None not in values:
        of = [int(count[1]) for count in counts]
        return f"{sum(round(value * count) for value, count in zip(values, of))} of {sum(of)} trials {trials[quantity]}"
    if quantity == "frames a second over Table 1's":
        return f"{span(values)} times Table 1\u2019s frames a second"
    if unit == "1/s" and quantity.startswith("frames a second"):
        name, _, how = quantity.replace(" f32", ", single precision").partition(", ")
        return f"{span(values)} {name}" + (f" ({how})" if how else "")
    return f"{quantity} {span(values)}" + (f" {unit}" if unit != "1" else "")


def farthest(claim, of_quantity=False, named=str):
    """The figure that is farthest from what is expected of it; of which quantity it is alone, or of whom as well. named: how a quantity
    is called."""
    said = re.search(r"; farthest: (.*?) is ([^\s;]+)(?:; |$)", claim["text"])
    if not said:
        return ""
    bounds = dict(part.rsplit(": ", 1) for part in claim["expected"].split("; ") if ": " in part)
    known = [*bounds, *(entry["quantity"] for entry in claim["measurements"])]
    quantity = next((quantity for quantity in known if said[1].startswith(f"{quantity} of ")), None)
    return (f"; farthest: {named(quantity) if of_quantity and quantity else said[1]} is {said[2]}, "
            f"expected {bounds.get(quantity, claim['expected'])}")


def sweeps_and_clips(claim):
    """Of a sweep its range, of clips what they are judged by: their means or shares of frames."""
    cases = own_cases(claim)
    clips = [case for case in cases if not is_sweep(case)]
    told = [case_text(claim, case) for case in cases if is_sweep(case)]
    return told + ([f"{counted(len(clips), 'clip')}: {clip_figures(claim, clips)}"] if clips else [])


def clip_figures(claim, clips):
    if is_share(claim):
        return f"{span([case['share_of_frames']['estimate'] for case in clips], 100)} % of the frames within"
    return f"means of {span([case['mean']['estimate'] for case in clips])} %"


def measured(claim):
    """The claim's own figures: every case, or every quantity's range; in brackets their intervals."""
    if claim["cases"]:
        cases = own_cases(claim)
        sweeps, clips = ([case_text(claim, case) for case in cases if is_sweep(case) == swept] for swept in (True, False))
        what = "share of frames within" if is_share(claim) else "mean"
        return items([*sweeps, *([f"Of clips the {what}, in % [95 % interval]:"] if clips else []), *clips], "plain")
    if not claim["measurements"]:
        return claim["measured"] or "\u2013"
    quantities = dict.fromkeys(entry["quantity"] for entry in claim["measurements"])
    return joined([claim["measured"], items([range_text(claim, quantity) for quantity in quantities], "plain")])


def case_text(claim, case):
    name = in_words(case["text"].split(":")[0])
    if is_sweep(case):
        return f"{name}: {span_of_thousandths([case['least'], case['most']])} % over the angle"
    share = is_share(claim)
    return f"{name}: " + behind.with_interval(case["share_of_frames" if share else "mean"], 100 if share else 1)


def is_share(claim):
    """Judged by the share of frames that hold, not by their mean."""
    return claim["interval_of"].startswith("share")


def range_text(claim, quantity):
    """From the least to the most of its figures, in brackets from the lowest to the highest end of their intervals."""
    entries = [entry for entry in claim["measurements"] if entry["quantity"] == quantity]
    unit = "" if entries[0]["unit"] == "1" else f" {entries[0]['unit']}"
    known = [entry for entry in entries if entry["value"] is not None]
    if not known:
        return f"{quantity}: no figure"
    values = [entry["value"] for entry in known]
    ends = [end for entry in known for end in (entry["low"], entry["high"]) if end is not None] or values
    interval = f" [{figure(min(ends))}, {figure(max(ends))}]" if (min(ends), max(ends)) != (min(values), max(values)) else ""
    return f"{quantity}: {span(values)}{interval}{unit}"


def expected(claim):
    parts = claim["expected"].split("; ")
    return items(parts, "plain") if len(parts) > 1 else claim["expected"].replace("-", "\u2212") or "\u2013"


def named_cell(column, cell):
    """Its column's name stands in it where rows are stacked."""
    return element("td", joined([element("span", column, class_="column"), cell]))


def row(claim, pose):
    """pose: link to it in the viewer, or none."""
    name = element("a", claim["id"], href=f"#{claim['id']}")
    statement = joined([claim["statement"], element("span", f" {claim['place']}", class_="place")]
                       + ([" ", element("a", "see it move", href=pose, class_="pose")] if pose else []))
    cells = [statement, mark(claim["verdict"]), expected(claim), measured(claim), outcome(claim)]
    return Markup(f'<tr id="{escaped(claim["id"])}" class="claim"><th scope="row">{name}</th>'
                  + joined(named_cell(column, cell) for column, cell in zip(columns[1:], cells))
                  + "</tr>")


def section(found, poses):
    if found.claims is None:
        return element("p", "claims.json: not there: `pbskin reproduce --judge -o DIR` judges the records", class_="missing")
    head = joined(element("th", name, scope="col") for name in columns)
    rows = [Markup(row(claim, poses.get(claim["id"])) + f'<tr class="behind"><td colspan="{len(columns)}">'
            f'{behind.of(claim, found)}</td></tr>') for claim in found.claims]
    table = Markup(f"<table class='claims'><caption>Each claim against the bound fixed beforehand</caption><thead><tr>{head}</tr></thead>"
                   "<tbody>\n" + joined(rows, "\n") + "</tbody></table>")
    return element("div", table, class_="scroll", tabindex=0, role="region", aria_label="Verdicts")
