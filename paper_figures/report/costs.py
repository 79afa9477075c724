"""What the studies cost: processor time expected beforehand and taken, from each study's costs.csv."""
from report.markup import counted, details, element, figure, joined, table
from report.record_set import number


def of_studies(found):
    """(study, rows of its costs.csv)."""
    files = ((file.parent.name, f"{file.parent.name}/costs.csv") for file in found.files("*/costs.csv"))
    return [(study, found.rows(name)) for study, name in files]


def total(rows, column):
    return sum(number(row, column) or 0.0 for row in rows)


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
    header = ["study", "runs", "expected [s]", "taken [s]"]
    rows = [[study, len(rows), figure(total(rows, "expected_cpu_s")), figure(total(rows, "cpu_s"))] for study, rows in studies]
    everything = [row for _, rows in studies for row in rows]
    rows.append([element("b", "all"), len(everything), figure(total(everything, "expected_cpu_s")), figure(total(everything, "cpu_s"))])
    single = [[f"{study}/{row['run']}", figure(number(row, "expected_cpu_s")), figure(number(row, "cpu_s"))]
              for study, rows in studies for row in rows]
    runs = table("Each run's processor time", ["run", "expected [s]", "taken [s]"], single, "tall")
    return joined([table("Processor time of the studies", header, rows), details("each run", runs)])
