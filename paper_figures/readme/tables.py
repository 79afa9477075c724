"""The tables of the README and of other pages: one line per claim of DIR/claims.json with its page, verdict and
numbers; the human's rows of DIR/timing/features_human/features.csv; the glossary; and the counts of the reliability
tests, DIR/*.json."""
import textwrap

import records
from readme import part
from records import shapes
from words import case_words, compared_methods, glossary, sentences

claim_head = "| | claim of the paper | verdict | measured | asked |"
claim_pages = "experiments/verdicts/claims"
features_page = part.source / "experiments" / "studies" / "timing" / "README.md"
features_head = ["| feature | processor ms per frame without | with | ratio [quartiles] | start [s] without | with "
                 "| peak [MB] without | with | the result moves |", "|---" * 9 + "|"]
glossary_page = part.source / "experiments" / "GLOSSARY.md"
reliability_page = part.source / "tests" / "README.md"
width = 138  # of a line of text


def filled(text, indent=""):
    """The lines of a paragraph; those after the first one begin with `indent`."""
    return textwrap.wrap(text.replace("\u2212", "-"), width, subsequent_indent=indent, break_long_words=False,
                         break_on_hyphens=False)


def line(*cells):
    return "| " + " | ".join(cells) + " |"


def of_revision(run):
    """The revision of a run.json's provenance, and whether the tree had local changes."""
    return run.get("git_revision", "unknown")[:12] + (" with local changes" if run.get("git_dirty") else "")


def claims_of(results):
    file = results / "claims.json"
    records.need(file.is_file(), f"{file.name}: does not exist: `pbskin reproduce --judge` writes it next to "
                                 "the records")
    return sentences.claims_of(file)


def page_link(claim, folder=claim_pages):
    return f"[{claim['id']}]({folder}/{sentences.page_of(claim['id'])}.md)"


def in_markdown(text):
    return text.replace("|", "\\|").replace("\u2212", "-")


def claims_table(results):
    """The lines of the table, the header first. What is behind a verdict is on the claim's page."""
    rows = [[page_link(claim), claim["short"], sentences.names[claim["verdict"]], claim["measured"] or "",
             claim["asked"] or ""]
            for claim in claims_of(results)]
    return [claim_head, "|---" * 5 + "|", *(line(*map(in_markdown, row)) for row in rows)]


def held_out_sentences(claims):
    """The verdicts on cases that were recorded after the rule was fixed, by verdict; no sentence without such cases."""
    by_verdict = {}
    for claim in claims:
        later = claim["held_out"]
        if later:
            by_verdict.setdefault(later["verdict"], []).append(claim["id"])
    parts = [f"{compared_methods.conjoined(ids, 'and')} {sentences.kinds[verdict][len(ids) != 1]}"
             for verdict, ids in by_verdict.items()]
    return ([f"On held-out cases, which were recorded after the thresholds were fixed, {'; '.join(parts)}."] if parts
            else [])


def claims_lines(results):
    """With each revision and the studies whose runs judge a claim and were measured at it. The revision with the most
    comes first."""
    table, studies = claims_table(results), {}
    judged = {run for claim in claims_of(results) for run in claim["runs"]}
    for file in sorted(file for file in results.glob("*/*/run.json") if "/".join(file.parts[-3:-1]) in judged):
        revision = of_revision(shapes.read(file, shapes.run).get("provenance", {}))
        studies.setdefault(revision, {})[file.parent.parent.name] = True
    records.need(studies, f"{results}: no run.json of a study's run in it")
    most, *others = sorted(studies, key=lambda revision: -len(studies[revision]))
    measured_at = ", ".join([most, *(f"{revision} ({', '.join(sorted(studies[revision]))})" for revision in others)])
    told = " ".join([*held_out_sentences(claims_of(results)), f"Measured at revision {measured_at}."])
    return [*table, "", *filled(told)]


def features_line(row):
    def pair(column, digits):
        return [f"{float(row[column + side]):.{digits}f}" for side in ("_without", "_with")]

    ratio, low, high = (f"{float(row['frame_cpu_ms_ratio' + end]):.2f}" for end in ("", "_lower", "_upper"))
    moves = f"{1e3 * float(row['largest_distance_m']):.2g} mm" if row["largest_distance_m"] else ""
    return line(case_words.of_field("feature", row["feature"]), *pair("frame_cpu_ms", 2), f"{ratio} [{low}, {high}]",
                *pair("start_s", 2), *pair("peak_mb", 0), moves)


def features_lines(results):
    folder = results / "timing" / "features_human"
    rows = records.table(folder / "features.csv", {"feature", "frame_cpu_ms_ratio"})
    return [*features_head, *map(features_line, rows), "",
            f"Measured at revision {of_revision(records.provenance(folder))}."]


def glossary_lines():
    return [line for entry in glossary.entries() for line in ("", f"## {entry.name}", "", entry.sentence)][1:]


def reliability_lines(folder):
    files = sorted(folder.glob("*.json"))
    records.need(files, f"{folder}: no record of a test")
    told = [shapes.read(file, shapes.reliability) for file in files]
    notes = [f" ({record['note']})" if record.get("note") else "" for record in told]
    return [line("what", "measured", "by", "revision"), "|---|---|---|---|",
            *(line(record["name"], f"{record['count']} of {record['of']}{note}", f"`{record['command']}`",
                   record["revision"][:12])
              for record, note in zip(told, notes))]
