"""The verification of the finite element reference itself, if that study is on record: its values, their sources and the origins of
bounds."""
from report.markup import element, inline, joined, table
from report.record_set import not_run, number
from words import case_words
from words.number_words import counted, figure

header = ["problem", "quantity", "elements", "material", "mesh", "degrees of freedom", "value", "reference", "unit", "difference [%]",
          "order (theory)", "bounds", "holds", "notes"]


def verdict(rows):
    """How many of the values with a bound lie within it."""
    bounded = [row["holds"] for row in rows if row["holds"]]
    return (f"{bounded.count('yes')} of {counted(len(bounded), 'value')} with a bound fixed beforehand lie within it; "
            f"{len(rows) - len(bounded)} more have no bound and are reported only.")


def notes_of(rows):
    """Sources and origins of bounds, each once, in the order of the rows."""
    return list(dict.fromkeys(row[column] for row in rows for column in ("source", "bound_from") if row[column]))


def cells(row, notes):
    ends = [number(row, "low"), number(row, "high")]
    order = "" if number(row, "observed_order") is None else f"{number(row, 'observed_order'):.2f}"
    theory = f" ({figure(number(row, 'expected_order'))})" if order and number(row, "expected_order") is not None else ""
    difference = number(row, "difference_pct")
    marks = [str(notes.index(row[column]) + 1) for column in ("source", "bound_from") if row[column]]
    return [row["problem"], inline(row["description"] + (f" ({row['note']})" if row["note"] else "")),
            case_words.elements(row["element_order"], row["formulation"]), case_words.material(row), row["mesh"], row["dofs"],
            figure(number(row, "value")), figure(number(row, "reference")), row["unit"],
            "" if difference is None else f"{difference:+.3g}".replace("-", "\u2212"), order + theory,
            "" if ends == [None, None] else f"{figure(ends[0])} to {figure(ends[1])}", row["holds"], ", ".join(marks)]


def section(found):
    rows = found.rows("verification/verification.csv")
    if not rows:
        return element("p", f"The reference against theory and benchmarks is {not_run(found, 'verification')}.", class_="missing")
    notes = notes_of(rows)
    shown = table("The reference against theory and published benchmarks", header, [cells(row, notes) for row in rows], "tall")
    answer = element("p", verdict(rows), class_="answer")
    return joined([answer, shown, element("ol", joined(element("li", inline(note)) for note in notes)) if notes else ""])
