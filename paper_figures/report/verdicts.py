"""The claims with their verdicts: the mark of each verdict with the class of its colour; a line for each claim with its
numbers on an axis, which opens to the cases, controls, comparisons and readings behind it. sentences.py composes the
sentences."""
from report import axis
from report.markup import Markup, beside_the_page, element, escaped, folder_link, items, joined, table
from words import case_words, glossary, sentences
from words.number_words import figure

marks = {"holds": ("\u2714", "holds"), "fails": ("\u2718", "fails"), "mixed": ("\u25d0", "partly"),
         "inconsistent_in_print": ("\u2260", "print"), "not_shown": ("\u25d4", "partly"),
         "inconclusive": ("\u25cb", "untested"), "untestable": ("\u2013", "untested"),
         "definition": ("\u2261", "untested"), "not_computable": ("?", "fails")}
most_rows = 400  # rows per table; claims.json has the rest


def mark_of(verdict):
    """(symbol, class, name)"""
    return (*marks[verdict], sentences.names[verdict])


def outcome(case):
    if case.get("excluded"):
        return "excluded: " + case_words.of_field("excluded", case["excluded"])
    return "\u2714 yes" if case["holds"] else "\u2718 no"


def case_rows(claim, case):
    """One row for each quantity of the case."""
    rows = []
    for part in sentences.parts(claim, case):
        has_quantity = "quantity" in case or "parts" in case
        of = ", ".join(filter(None,
                              [case_words.of(part), sentences.title(claim, part["quantity"]) if has_quantity else ""]))
        ends = "" if part.get("low") == part.get("high") else f"{figure(part['low'])} to {figure(part['high'])}"
        rows.append([of, sentences.shown(part), ends or "\u2013", sentences.threshold(part), outcome(part)])
    return rows


def case_table(claim, name, cases):
    if not cases:
        return ""
    header = ["printed value" if claim["rule"] == "printed" else "case", "number", sentences.range_name(claim),
              "threshold", "holds"]
    rows = [row for case in cases[:most_rows] for row in case_rows(claim, case)]
    left = len(cases) - most_rows
    shown = table(name, header, rows, "tall")
    return joined([shown, element("p", f"claims.json has {left} more.")]) if left > 0 else shown


def rows_table(claim, what, header, rows):
    return table(f"{claim['id']}: {what}", header, rows) if rows else ""


def behind(claim, found):
    """What the reader sees of an open line: the facts, the cases, the controls, and what is compared."""
    what = "printed value" if claim["rule"] == "printed" else "case"
    basis = sentences.basis(claim)
    later = sentences.held_out(claim)
    controls_later = sentences.control_rows(later) if later else []
    parts = [listed(sentences.facts(claim) + sentences.on_held_out_cases(claim)), element("p", basis) if basis else "",
             case_table(claim, f"{claim['id']}: {what}s", claim["cases"]),
             rows_table(claim, "controls", sentences.control_head, sentences.control_rows(claim)),
             rows_table(claim, "for comparison, no part of the verdict", sentences.compared_head,
                        sentences.compared_rows(claim)),
             rows_table(claim, "other readings, no part of the verdict", sentences.reading_head,
                        sentences.reading_rows(claim)),
             *(element("p", text) for text in sentences.disagreements(claim)),
             case_table(claim, f"{claim['id']}: held-out cases", (later or {}).get("cases")),
             rows_table(claim, "controls of the held-out cases", sentences.control_head, controls_later),
             *(case_table(claim, f"{claim['id']}: {of['name']}", of["cases"]) for of in claim["controls"])]
    runs = joined((folder_link(found.results, run) for run in claim["runs"] or [claim["study"]]), ", ")
    parts.append(element("p", joined(["Runs (", beside_the_page("folders"), "): ", runs])))
    return joined(parts, "\n")


def mark(verdict):
    symbol, colour, name = mark_of(verdict)
    return Markup(f'<span class="mark {colour}"><span aria-hidden="true">{symbol}</span> {escaped(name)}</span>')


def both_marks(claim):
    """That on the held-out cases stands next to the other one."""
    later = sentences.held_out(claim)
    return joined([mark(claim["verdict"]), *(["; on the held-out cases: ", mark(later["verdict"])] if later else [])])


def measured(claim):
    """The cell of the short table: what was measured, and the threshold."""
    first = claim.get("measured") or (sentences.facts(claim) or [""])[0]
    return joined([first, element("span", f"asked: {claim['asked']}", class_="under") if claim.get("asked") else ""])


def short_row(claim, here):
    symbol, colour, name = mark_of(claim["verdict"])
    chip = element("span", joined([element("span", symbol, aria_hidden="true"), " ", name]), class_=f"chip {colour}")
    cells = [("name", element("a", claim["id"], href=f"#{claim['id']}")),
             ("short", claim.get("short") or claim["statement"]), ("of-verdict", chip), ("measured", measured(claim)),
             *here]
    return Markup("<tr>" + joined(element("td", text, class_=class_) for class_, text in cells) + "</tr>")


def short_table(found):
    """The claims by topic: what each states, its verdict, and what was measured, on the record and on this machine."""
    by_topic, repeated = {}, found.repeated["claims"]
    for claim in found.claims:
        by_topic.setdefault(case_words.of_field("topic", claim["study"]), []).append(claim)
    head = ["", "claim of the paper", "verdict", "measured", *(["on this machine"] if repeated else [])]
    parts = ["<table class=\"claims\"><thead><tr>", joined(element("th", cell, scope="col") for cell in head),
             "</tr></thead>"]
    for topic, claims in by_topic.items():
        rows = joined((short_row(claim, [("here", repeated.get(claim["id"], {}).get("text", ""))] if repeated else [])
                       for claim in claims),
                      "\n")
        title = element("th", topic, colspan=len(head), scope="rowgroup")
        parts += [f"<tbody><tr class=\"topic\">{title}</tr>\n{rows}</tbody>"]
    return Markup("".join(parts) + "</table>")


def listed(texts):
    return items(texts, "plain") if len(texts) > 1 else "".join(texts) or "\u2013"


def line(claim, found, pose, drawn):
    """One line, which opens. pose: the link to it in the viewer, or None; drawn: the figures of the page."""
    statement = element("span", joined([element("b", claim["id"]), f" {claim['statement']} ",
                                        element("span", claim["place"], class_="place")]), class_="statement")
    first = [*sentences.why_inconclusive(claim)[:1], *(sentences.facts(claim) or [""])[:1], *sentences.by_chance(claim)]
    verdict = element("span",
                      joined([both_marks(claim), element("span", "; ".join(dict.fromkeys(first)), class_="under")]),
                      class_="verdict")
    summary = element("summary", joined([statement, verdict, element("span", axis.drawn(claim), class_="numbers")]))
    where = [element("a", "see it move", href=pose, class_="pose")] if pose else []
    where += [element("a", f"figure: {entry.title}", href=f"#figure-{entry.name}") for entry in drawn
              if claim["id"] in entry.claims]
    links = element("p", joined(where, ", "), class_="links") if where else ""
    return Markup('<details class="claim" '
                  f'id="{escaped(claim["id"])}">{summary}{joined([links, behind(claim, found)])}</details>')


legend = ("A dot is a case: a body with a clip, a joint or a mesh; green ones hold. The shaded band is the threshold. "
          "A triangle is a negative control, which must fail, or a positive control, which must hold. Click a line for "
          "its data.")


def section(found, poses, drawn):
    if found.claims is None:
        return element("p", "claims.json is missing: `pbskin reproduce --judge -o DIR` judges the records",
                       class_="missing")
    lines = [line(claim, found, poses.get(claim["id"]), drawn) for claim in found.claims]
    return joined([element("p", glossary.linked(escaped(legend), set()), class_="lead"), *lines], "\n")
