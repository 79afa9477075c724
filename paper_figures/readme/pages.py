"""Writes the generated part of each study's README and of each claim's page, from tables and records: the purpose, figures and cost of a
study; the bounds and the verdict of a claim. Nobody edits it by hand.
"""
import tomllib

import records
from readme import part, tables
from records import entries
from words import case_words, sentences
from words.number_words import counted, span_of_thousandths

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


def too_long(study, results):
    listed = results / study / "not_kept.csv"
    if not listed.exists():
        return []
    names = sorted({f"`RUN/{row['file']}`" if row["run"] else f"`{row['file']}`" for row in records.read_rows(listed)})
    return [f"These files are too long to be kept, in some runs or in all: {', '.join(names)}."]


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
    return result[:-1] + compared_lines(judged, own_deformer(claim))


def own_deformer(claim):
    """The deformer that a claim is about; None where other fields distinguish its values too, such as orders of projection."""
    of = claim.get("of", {})
    return of.get("deformer") if list(of) == ["deformer"] else claim.get("deformer")


def held_by_runs(_, runs):
    """Frames within the bound, of all; and the smallest and the largest value of all frames."""
    frames = sum(run["frames"] for run in runs)
    held = sum(round(run["share_of_frames"]["estimate"] * run["frames"]) for run in runs)
    ends = [end for run in runs for end in (run["least"], run["most"])]
    return f"{held} of {counted(frames, 'frame')} in {counted(len(runs), 'run')}", [min(ends), max(ends)]


def held_by_values(bound, values):
    """Values within the bound, of all; and the smallest and the largest value."""
    low, high = (float(sign + "inf") if end is None else end for sign, end in (("-", bound["low"]), ("", bound["high"])))
    known = [value["value"] for value in values]
    return f"{sum(low <= value <= high for value in known)} of {counted(len(known), 'value')}", [min(known), max(known)]


def compared_rows(claim, own, bound):
    """One row per deformer other than the claim's own, in the order of claims.json."""
    groups = {}
    for value in claim["controls"]:
        if value["quantity"] == bound["quantity"] and value.get("deformer") not in (None, own) and value.get("value") is not None:
            groups.setdefault(value["deformer"], []).append(value)
    for deformer, values in groups.items():
        held, ends = (held_by_runs if "frames" in values[0] else held_by_values)(bound, values)
        unit = " %" if bound["quantity"].endswith("_pct") else ""
        yield f"| {case_words.of_field('deformer', deformer)} | {span_of_thousandths(ends)}{unit} | {held} |"


def compared_lines(claim, own):
    """How other deformers and the finite elements do under the bounds of a claim, from the values that claims.json has for comparison
    (`controls`): a table per bounded quantity, or no line if nothing was measured. own: the deformer that the claim is about, or None if it
    is not about a deformer alone."""
    found = []
    for bound in claim["bounds"] if own else []:
        if table := list(compared_rows(claim, own, bound)):
            title = sentences.title(claim, bound["quantity"])
            found += ["", f"| deformer | {title} | within the bound |", "|---|---|---|", *table]
    introduction = ["", "For comparison, the tables show other deformers and finite elements under the same bounds. "
                        "They are no part of the verdict."]
    return [line.replace("\u2212", "-") for line in introduction + found] if found else []


def pages(results):
    """Each page with its generated lines."""
    judged = {claim["id"]: claim for claim in tables.claims_of(results)}
    found = {}
    for study in study_names():
        parts = served_claims(study), drawn_figures(study), summaries(study, results), cost(study, results), too_long(study, results)
        found[studies / study / "README.md"] = [line for part in parts if part for line in [*part, ""]][:-1]
    for claim in listed_claims():
        found[claim_pages / f"{claim['id']}.md"] = claim_lines(claim, judged[claim["id"]])
    return found
