"""The origin of the records: revision, machine, libraries, inputs, what was left out, and the licences of what is
shown; the expected and measured time of the studies; and how to cite the suite and the paper that it examines, from
CITATION.cff."""
import pathlib
import re

from report.markup import details, element, items, joined, table
from report.record_set import number
from words import case_words
from words.number_words import counted, figure


def values_of(found, key):
    """For each value, the number of runs that have it."""
    values = {}
    for run in found.runs.values():
        origin = run.get("provenance", {})
        value = origin.get(key, "not recorded")
        if key == "git_revision" and origin.get("git_dirty"):
            value = f"{value} (with local changes)"
        values[value] = values.get(value, 0) + 1
    return values


def facts_table(found):
    def told(values):
        return "; ".join(str(value) if len(values) == 1 else f"{value} ({counted(count, 'run')})"
                         for value, count in values.items())

    rows = [[label, told(values_of(found, key))] for key, label in case_words.tables["provenance"].items()]
    libraries = {f"{name} {version}" for run in found.runs.values()
                 for name, version in run.get("provenance", {}).get("libraries", {}).items()}
    rows.append(["libraries", ", ".join(sorted(libraries, key=str.lower))])
    return table(f"The origin of {counted(len(found.runs), 'run')}", ["what", "value"], rows)


def inputs_table(found):
    inputs = {}
    for name, run in found.runs.items():
        for file, value in run.get("provenance", {}).get("input_hashes", {}).items():
            inputs.setdefault((file, value), []).append(name)
    rows = [[file, element("code", value), len(runs), ", ".join(runs[:3]) + (", \u2026" if len(runs) > 3 else "")]
            for (file, value), runs in sorted(inputs.items())]
    if not rows:
        return ""
    return details(f"inputs and their hashes ({len(rows)})", table("Inputs", ["input", "hash", "runs", "such as"], rows,
                                                                   "tall"))


def texts_in(value):
    """Every text in a record of scenes and settings."""
    if isinstance(value, str):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
        yield from texts_in(part)


def rights(found):
    """The licences of the bodies and clips that the runs used."""
    used = {text for run in found.runs.values() for text in texts_in([run.get("scene", {}), run.get("work", {})])}
    bodies = [text for body, text in case_words.tables["licence"].items()
              if body in used or any(name.split("/")[-1].startswith(body) for name in found.runs)]
    clips = [case_words.tables["credit"]["clip"]] if any(text.endswith(".bvh") for text in used) else []
    return [*bodies, *clips]


def section(found, with_viewer=False):
    revisions = len(values_of(found, "git_revision"))
    parts = ([element("p", f"Note: the records are of {revisions} revisions.", class_="missing")] if revisions > 1
             else [])
    parts += [facts_table(found), inputs_table(found)]
    for title, shown in (("Excluded", [f"{study}: {scene}: {reason}" for study, scene, reason in found.left_out()]),
                         ("Bodies and motions", rights(found)),
                         ("Program of the viewer", [case_words.tables["credit"]["viewer"]] if with_viewer else [])):
        parts += [element("h3", title), items(shown)] if shown else []
    return joined(parts, "\n")


def of_studies(found):
    """The rows of each study's costs.csv."""
    return {file.parent.name: found.rows(f"{file.parent.name}/costs.csv") for file in found.files("*/costs.csv")}


def total(rows, column):
    return sum(number(row, column) or 0.0 for row in rows)


def totals(rows):
    """The number of rows and their sums; wall time only if each of them has it."""
    wall = figure(total(rows, "wall_s")) if all(row.get("wall_s") for row in rows) else "\u2013"
    return [len(rows), figure(total(rows, "expected_cpu_s")), figure(total(rows, "cpu_s")), wall]


def costs_sentence(found):
    studies = of_studies(found)
    if not studies:
        return ""
    taken_s = sum(total(rows, "cpu_s") for rows in studies.values())
    taken = f"{figure(taken_s / 60)} min" if taken_s >= 60 else f"{figure(taken_s)} s"
    return f"These records took {taken} of processor time ({counted(len(studies), 'study', 'studies')})."


def costs_section(found):
    studies = of_studies(found)
    if not studies:
        return element("p", "no study left its costs.csv", class_="missing")
    header = ["runs", "processor, expected [s]", "processor, taken [s]", "total wall time of the runs [s]"]
    # Quick or full, from the study's plan; plans of earlier versions do not state it.
    rows = [[study, found.plans.get(study, {}).get("extent", "\u2013"), *totals(rows)]
            for study, rows in studies.items()]
    rows.append([element("b", "all"), "", *totals([row for rows in studies.values() for row in rows])])
    single = [[f"{study}/{row['run']}", *totals([row])[1:]] for study, rows in studies.items() for row in rows]
    each = table("Each run's time", ["run", *header[1:]], single, "tall")
    return joined([table("Time of the studies", ["study", "size", *header], rows), details("each run", each)])


citation = pathlib.Path(__file__).resolve().parents[2] / "CITATION.cff"


def value(text, key):
    found = re.search(rf'^\s*(?:- )?{key}: "?([^"\n]*)"?$', text, re.M)
    return found.group(1) if found else ""


def citation_section(found):
    if not citation.is_file():
        return element("p", "CITATION.cff: does not exist", class_="missing")
    own, *references = re.split(r"^references:", citation.read_text(), flags=re.M)
    revision = next(iter(found.runs.values())).get("provenance", {}).get("git_revision", "unknown")
    authors = ", ".join(re.findall(r'- name: "([^"]+)"', own))
    parts = [element("p", f"{authors}: {value(own, 'title')}, version {value(own, 'version')}, "
                          f"{value(own, 'license')}. "
                          f"Revision of these records: {revision}.")]
    for text in references:
        families, given = (re.findall(rf'{name}-names: "([^"]+)"', text) for name in ("family", "given"))
        authors = ", ".join(f"{first} {last}" for first, last in zip(given, families))
        told = (f"The paper: {authors}: {value(text, 'title')}. {value(text, 'collection-title')}, "
                f"{value(text, 'year')}.")
        parts.append(element("p", told))
    return joined([*parts, details("CITATION.cff", element("pre", citation.read_text(), tabindex=0))])
