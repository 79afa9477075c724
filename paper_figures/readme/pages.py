"""Writes the generated part of each study's README and of each claim's page, from tables and records: the purpose, figures and cost of a
study; the bounds and the verdict of a claim. Nobody edits it by hand.
"""
import csv
import json
import tomllib

import records
from readme import part
from records import entries
from words import compared_results, sentences

experiments = part.source / "experiments"
studies = experiments / "studies"
claim_pages = experiments / "verdicts" / "claims"


def listed_claims():
    return tomllib.loads((experiments / "verdicts" / "claims.toml").read_text(encoding="utf-8"))["claim"]


def study_names():
    """Every folder with a README, except what the studies share."""
    return sorted(page.parent.name for page in studies.glob("*/README.md") if page.parent.name != "shared")


def served_claims(study):
    served = [claim for claim in listed_claims() if claim["study"] == study]
    if not served:
        return ["No claim is judged by this study."]
    return [f"- [{claim['id']}](../../verdicts/claims/{claim['id']}.md): {claim['statement']}" for claim in served]


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
    with file.open(newline="", encoding="utf-8") as rows:
        seconds = {row["run"]: float(row["cpu_s"]) for row in csv.DictReader(rows)}
    plan = json.loads((results / study / "plan.json").read_text(encoding="utf-8"))
    form = {"quick": " in the quick form", "full": " in the full form"}.get(plan.get("extent"), "")
    longest = max(seconds, key=seconds.get)
    runs = "one run" if len(seconds) == 1 else f"{len(seconds)} runs"
    text = f"The kept record{form} has {runs} and took {sum(seconds.values()) / 60:.1f} minutes of processor time"
    return [text + ("." if len(seconds) == 1 else f", the longest run `{longest}` {seconds[longest] / 60:.1f}.")]


def summaries(study, results):
    """The texts that the study itself wrote for its readers."""
    files = sorted(file.name for pattern in ("*.md", "*.txt") for file in (results / study).glob(pattern))
    links = ", ".join(f"[{file}](../../records/full/{study}/{file})" for file in files)
    return [f"To read what was found: {links}."] if files else []


def too_long(study, results):
    listed = results / study / "not_kept.csv"
    if not listed.exists():
        return []
    with listed.open(newline="", encoding="utf-8") as file:
        names = sorted({f"`RUN/{row['file']}`" if row["run"] else f"`{row['file']}`" for row in csv.DictReader(file)})
    return [f"These files are too long to be kept, in some runs or in all: {', '.join(names)}."]


def study_lines(study, results):
    parts = [served_claims(study), drawn_figures(study), summaries(study, results), cost(study, results), too_long(study, results)]
    return [line for part in parts if part for line in [*part, ""]][:-1]


def bound_lines(claim):
    """The bound of each judged quantity, as in claims.toml."""
    bounds = {bound["quantity"]: bound for bound in claim.get("bounds", [])}
    low, high = (claim.get(key, claim.get(f"{key}_pct")) for key in ("low", "high"))
    rows = []
    for quantity in claim.get("metrics", []) if claim["rule"] != "printed" else []:  # in a printed claim each value has its own bounds
        bound = bounds.get(quantity, {"low": low, "high": high})
        rows.append(f"| `{quantity}` | {number(bound.get('low'))} | {number(bound.get('high'))} |")
    return ["| judged quantity | least | most |", "|---|---|---|", *rows, ""] if rows else []


def number(bound):
    return "" if bound is None or abs(bound) >= 1e9 else f"{bound:g}"


def claim_lines(claim, judged):
    verdict, measured = sentences.names[judged["verdict"]], sentences.measured_in_line(judged).replace("\u2212", "-")
    result = [f"Study: [{claim['study']}](../../studies/{claim['study']}/README.md). Verdict: **{verdict}**.", ""]
    result += [*bound_lines(claim), *([f"Measured: {measured}.", ""] if measured else [])]
    return result[:-1] + compared_results.lines(judged, own_deformer(claim))


def own_deformer(claim):
    """The deformer that a claim is about; None where other fields distinguish its values too, such as orders of projection."""
    of = claim.get("of", {})
    return of.get("deformer") if list(of) == ["deformer"] else claim.get("deformer")


def pages(results):
    """Each page with its generated lines."""
    file = results / "claims.json"
    if not file.is_file():
        raise records.RecordsMissing(f"{file.name}: does not exist: `pbskin reproduce --judge` writes it next to the records")
    judged = {claim["id"]: claim for claim in sentences.claims_of(file)}
    found = {studies / study / "README.md": study_lines(study, results) for study in study_names()}
    for claim in listed_claims():
        found[claim_pages / f"{claim['id']}.md"] = claim_lines(claim, judged[claim["id"]])
    return found
