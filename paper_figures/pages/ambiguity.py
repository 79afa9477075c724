"""How much each other reading of the paper changes the values of claims, by body, and which verdicts flip."""
import math

import pages
from words import case_words

places = case_words.tables["place"]


def size_of_change(row):
    """How far B over A is from 1, either way."""
    if not row["change"]:
        return -1.0
    if not row["b_over_a"]:
        return 0.0 if float(row["change"]) == 0.0 else math.inf
    ratio = float(row["b_over_a"])
    return abs(math.log(ratio)) if ratio > 0.0 else math.inf


def cell(rows):
    """The value of a body, a reading and a claim: the one whose verdict flips, or else the one that changes most."""
    if not rows:
        return ""
    chosen = max(rows, key=lambda row: (row["verdict_flips"] == "yes", size_of_change(row)))
    value = "x" + format(float(chosen["b_over_a"]), ".3g") if chosen["b_over_a"] else (
        "0>" + format(float(chosen["b"]), ".2g") if chosen["a"] and chosen["b"] else "-")
    return value + ("!" if chosen["verdict_flips"] == "yes" else "")


def of_body(rows, claims):
    readings = dict.fromkeys((row["place"], row["reading_b"]) for row in rows)
    columns = {"place": lambda reading: places.get(reading[0], reading[0]), "reading": lambda reading: reading[1]}
    for claim in claims:
        columns[claim] = lambda reading, claim=claim: cell(
            [row for row in rows if (row["place"], row["reading_b"], row["claim"]) == (*reading, claim)])
    return pages.table(readings, columns)


def of_claim(claim, rows):
    """The readings by which its verdict flips, and why others have no value."""
    def named(flips, name):
        return list(dict.fromkeys(name(row) for row in rows if row["verdict_flips"] == flips))

    flipping = named("yes", lambda row: f"{row['body']}, {row['reading_b']}")
    values, flips = (sum(row["verdict_flips"] in of for row in rows) for of in (("yes", "no"), ("yes",)))
    text = f"- {claim}: {flips} of {values} values flip" + (" by " + "; ".join(flipping) if flipping else "")
    for reason in named("no_value", lambda row: row["reason"]):
        quantities = dict.fromkeys(row["quantity"] for row in rows
                                   if (row["verdict_flips"], row["reason"]) == ("no_value", reason))
        text += f"\n  - no value: {reason}: {', '.join(quantities)}"
    return text + "\n"


def page(folder):
    rows = pages.of_runs(folder, "ambiguity.csv", {"body", "place", "reading_b", "claim", "quantity", "a", "b",
                                                   "change", "b_over_a", "verdict_flips", "reason"})
    claims = sorted({row["claim"] for row in rows})
    text = ("# How other readings of the paper change the values of claims\n\nA cell is B over A of the value whose "
            "verdict flips, or else of the one that changes most. `!`: its verdict flips; `-`: no value; empty: not "
            "measured, since the claim's study does not depend on it.\n")
    for body in dict.fromkeys(row["body"] for row in rows):
        text += f"\n## {body}\n\n" + of_body([row for row in rows if row["body"] == body], claims)
    return text + "\n## Verdicts that flip\n\n" + "".join(
        of_claim(claim, [row for row in rows if row["claim"] == claim]) for claim in claims)
