"""The verdicts: counts, short texts, and a table whose rows open to the runs behind them. sentences.py composes the sentences."""
from report import behind
from report.markup import Markup, element, escaped, items, joined
from report.verdict_names import counted_in_words, mark_of
from words import sentences
from words.number_words import counted

columns = ("claim", "statement", "verdict", "expected", "measured", "for whom")


def mark(verdict):
    symbol, colour, name = mark_of(verdict)
    return Markup(f'<span class="mark {colour}"><span aria-hidden="true">{symbol}</span> {escaped(name)}</span>')


def counts_sentence(claims):
    """There are 17 claims: 3 are reproduced, 8 are reproduced in part, ..."""
    return f"There {'is' if len(claims) == 1 else 'are'} {counted(len(claims), 'claim')}: {counted_in_words(claims)}."


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
    ranges = [f"{name}: {sentences.range_with_intervals(values)}" for name, values in sentences.judged_groups(claim).items()]
    return joined([sentences.within(claim), items(ranges, "plain")])


def expected(claim):
    texts = [text.replace("-", "\u2212") if claim["expected"] is not None else text for text in sentences.expected(claim)]
    return items(texts, "plain") if len(texts) > 1 else "".join(texts) or "\u2013"


def named_cell(column, cell):
    """A cell that contains the name of its column, for narrow screens on which cells are stacked."""
    return element("td", joined([element("span", column, class_="column"), cell]))


def row(claim, pose):
    """pose: the link to it in the viewer, or None."""
    name = element("a", claim["id"], href=f"#{claim['id']}")
    statement = joined([claim["statement"], element("span", f" {claim['place']}", class_="place")]
                       + ([" ", element("a", "see it move", href=pose, class_="pose")] if pose else []))
    cells = [statement, mark(claim["verdict"]), expected(claim), measured(claim), sentences.outcome(claim)]
    return Markup(f'<tr id="{escaped(claim["id"])}" class="claim"><th scope="row">{name}</th>'
                  + joined(named_cell(column, cell) for column, cell in zip(columns[1:], cells))
                  + "</tr>")


def section(found, poses):
    if found.claims is None:
        return element("p", "claims.json is missing: `pbskin reproduce --judge -o DIR` judges the records", class_="missing")
    head = joined(element("th", name, scope="col") for name in columns)
    rows = [Markup(row(claim, poses.get(claim["id"])) + f'<tr class="behind"><td colspan="{len(columns)}">'
            f'{behind.of(claim, found)}</td></tr>') for claim in found.claims]
    table = Markup(f"<table class='claims'><caption>Each claim against the bound fixed beforehand</caption><thead><tr>{head}</tr></thead>"
                   "<tbody>\n" + joined(rows, "\n") + "</tbody></table>")
    return element("div", table, class_="scroll", tabindex=0, role="region", aria_label="Verdicts")
