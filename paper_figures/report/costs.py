"""The cost of the studies: expected and measured processor time, and wall time, from each study's costs.csv."""
from report.markup import details, element, joined, table
from report.record_set import number
from words.number_words import counted, figure


def of_studies(found):
    """(study, rows of its costs.csv)."""
    files = ((file.parent.name, f"{file.parent.name}/costs.csv") for file in found.files("*/costs.csv"))
    return [(study, found.rows(name)) for study, name in files]


def total(rows, column):
    return sum(number(row, column) or 0.0 for row in rows)


def size(found, study):
    """Quick or full, from the study's plan; plans of earlier versions do not state it."""
    return found.plans.get(study, {}).get("extent", "\u2013")


def totals(rows):
    """The number of rows and their sums; wall time only if each of them has it."""
    wall = figure(total(rows, "wall_s")) if all(row.get("wall_s") for row in rows) else "\u2013"
    return [len(rows), figure(total(rows, "expected_cpu_s")), figure(total(rows, "cpu_s")), wall]


def minutes(seconds):
    return f"{figure(seconds / 60)} min" if seconds >= 60 else f"{figure(seconds)} s"


def sentence(found):
    studies = of_studies(found)
    if not studies:
        return ""
    taken = sum(total(rows, "cpu_s") for _, rows in studies)
    return f"These records took {minutes(taken)} of processor time ({counted(len(studies), 'study', 'studies')})."


def section(found):
    studies = of_studies(found)
    if not studies:
        return element("p", "no study left its costs.csv", class_="missing")
    header = ["runs", "processor, expected [s]", "processor, taken [s]", "total wall time of the runs [s]"]
    rows = [[study, size(found, study), *totals(rows)] for study, rows in studies]
    rows.append([element("b", "all"), "", *totals([row for _, rows in studies for row in rows])])
    single = [[f"{study}/{row['run']}", *totals([row])[1:]] for study, rows in studies for row in rows]
    each = table("Each run's time", ["run", *header[1:]], single, "tall")
    return joined([table("Time of the studies", ["study", "size", *header], rows), details("each run", each)])
