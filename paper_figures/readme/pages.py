"""Writes the generated part of each study's README and of each claim's page, from tables and records: the purpose,
figures and cost of a study; the verdict of a claim with its controls and comparisons. Nobody edits it by hand.
"""
import tomllib

import records
from readme import part, tables
from records import entries
from words import sentences

experiments = part.source / "experiments"
studies = experiments / "studies"
claim_pages = experiments / "verdicts" / "claims"


def meshes():
    return records.read_rows(experiments / "records" / "other_tets.csv")


def listed_claims():
    return tomllib.loads((experiments / "verdicts" / "claims.toml").read_text(encoding="utf-8"))["claim"]


def study_names():
    """Every folder with a README, except what the studies share."""
    return sorted(page.parent.name for page in studies.glob("*/README.md") if page.parent.name != "shared")


def served_claims(study):
    served = [claim for claim in listed_claims() if claim["study"] == study]
    if not served:
        return ["No claim is judged by this study."]
    return [f"- {tables.page_link(claim, '../../verdicts/claims')}: {claim['statement']}" for claim in served]


def drawn_figures(study):
    drawn = [entry for entry in entries.read() if study in entry.studies()]
    if not drawn:
        return ["No figure is drawn from it."]
    names = ", ".join(f"`{entry.name}`" for entry in drawn)
    return [f"`paper_figures/make_all.py DIR` draws {names}."]


def cost(study, results):
    file = results / study / "costs.csv"
    if not file.is_file():
        return ["The kept records do not have this study."]
    seconds = {row["run"]: float(row["cpu_s"]) for row in records.read_rows(file)}
    extent = records.read_json(results / study / "plan.json").get("extent")
    form, longest = f" in the {extent} form" if extent in ("quick", "full") else "", max(seconds, key=seconds.get)
    runs = "one run" if len(seconds) == 1 else f"{len(seconds)} runs"
    text = f"The kept record{form} has {runs} and took {sum(seconds.values()) / 60:.1f} minutes of processor time"
    return [text + ("." if len(seconds) == 1 else f", the longest run `{longest}` {seconds[longest] / 60:.1f}.")]


def summaries(study, results):
    """The texts that the study itself wrote for its readers."""
    files = sorted(file.name for pattern in ("*.md", "*.txt") for file in (results / study).glob(pattern))
    links = ", ".join(f"[{file}](../../records/full/{study}/{file})" for file in files)
    return [f"To read what was found: {links}."] if files else []


def not_kept(study, results):
    listed = results / study / "not_kept.csv"
    if not listed.exists():
        return []
    names = sorted({f"`RUN/{row['file']}`" if row["run"] else f"`{row['file']}`" for row in records.read_rows(listed)})
    return [f"These files are not kept, in some runs or in all: {', '.join(names)}."]


def markdown_table(head, rows):
    return ["", tables.line(*head), "|---" * len(head) + "|",
            *(tables.line(*map(tables.in_markdown, row)) for row in rows)] if rows else []


def claim_lines(claim):
    """Verdict and primary number of a claim; its controls, comparisons and readings, which are no part of the
    verdict."""
    lines = [f"**{claim['id']}: {sentences.both_verdicts(claim)}.** {claim['statement']}", "",
             f"{sentences.in_line(claim)}."]
    basis = sentences.basis(claim)
    rows_on_meshes = meshes()
    depends = (sentences.without_a_body(claim) + sentences.on_other_tets(claim, rows_on_meshes)
               + sentences.threshold_ranges(claim))
    told = [*([basis] if basis else []), *(f"{text}." for text in depends + sentences.on_held_out_cases(claim))]
    lines = [tables.in_markdown(text) for text in lines + [line for text in told for line in ("", text)]]
    lines += markdown_table(sentences.control_head, sentences.control_rows(claim))
    lines += markdown_table(sentences.compared_head, sentences.compared_rows(claim))
    lines += markdown_table(sentences.reading_head, sentences.reading_rows(claim))
    lines += markdown_table(sentences.other_tets_head, sentences.other_tets_rows(claim, rows_on_meshes))
    rows = sentences.control_rows(sentences.held_out(claim)) if sentences.held_out(claim) else []
    if rows:
        lines += ["", "Controls on the held-out cases:", *markdown_table(sentences.control_head, rows)]
    return lines + [line for text in sentences.disagreements(claim) for line in ("", text)]


def claim_page_lines(claims):
    """A page serves a claim of the paper, which may be two here, such as C02a and C02b."""
    differing = [[f"**{claim['id']} has two verdicts: {sentences.both_verdicts(claim)}.**"] for claim in claims
                 if sentences.held_out(claim) and sentences.held_out(claim)["verdict"] != claim["verdict"]]
    parts = [*differing, [f"Study: [{claims[0]['study']}](../../studies/{claims[0]['study']}/README.md)."],
             *map(claim_lines, claims)]
    return [line for part in parts for line in ["", *part]][1:]


def pages(results):
    """Each page with its generated lines."""
    found = {}
    for study in study_names():
        parts = served_claims(study), drawn_figures(study), summaries(study, results), cost(study, results), not_kept(
            study, results)
        found[studies / study / "README.md"] = [line for part in parts if part for line in [*part, ""]][:-1]
    served = {}
    for claim in tables.claims_of(results):
        served.setdefault(claim_pages / f"{sentences.page_of(claim['id'])}.md", []).append(claim)
    return found | {page: claim_page_lines(claims) for page, claims in served.items()}
