"""How to cite the suite, from CITATION.cff, and the paper that it examines."""
import pathlib
import re

from report.markup import details, element, joined

file = pathlib.Path(__file__).resolve().parents[2] / "CITATION.cff"


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


def section(found):
    if not file.is_file():
        return element("p", "CITATION.cff: does not exist", class_="missing")
    own, *references = re.split(r"^references:", file.read_text(), flags=re.M)
    revision = next(iter(found.runs.values())).get("provenance", {}).get("git_revision", "unknown")
    parts = [element("p", suite_sentence(own) + f" Revision of these records: {revision}.")]
    parts += [element("p", "The paper: " + paper_sentence(text)) for text in references]
    return joined([*parts, details("CITATION.cff", element("pre", file.read_text(), tabindex=0))])
