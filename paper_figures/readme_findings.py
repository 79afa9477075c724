"""Writes the findings of the README: five sentences with one number each, from the facts in DIR/claims.json and the studies' tables below
DIR.

    python3 paper_figures/readme_findings.py results/reproduce
"""
import sys

import readme_part
import records
import sentences


def only(rows, what, **wanted):
    """The only row or fact with these fields."""
    found = [row for row in rows if all(row.get(name) == value for name, value in wanted.items())]
    if len(found) != 1:
        raise records.RecordsMissing(f"{what}: {len(found)} with {wanted}: expected one")
    return found[0]


def of(claims, name):
    return only(claims, "claims.json: claims", id=name)


def values_of(claims, name, quantity):
    values = [case["value"] for case in of(claims, name)["cases"] if case["quantity"] == quantity and case["value"] is not None]
    if not values:
        raise records.RecordsMissing(f"claims.json: {name}: no value of {quantity}")
    return values


def volume(results, claims):
    of_human = only(of(claims, "C02")["cases"], "claims.json: C02", quantity="volume_change_pct", scene="human_01_01", variant=None)
    share = of_human["share_of_frames"]
    return ("**Volume.** PBS with 24 iterations stays within 0.5 % of the human's volume in "
            f"{100 * share['estimate']:.0f} % of the frames of a jump "
            f"(95 % interval {100 * share['low']:.0f} to {100 * share['high']:.0f} %).")


def artefacts(results, claims):
    sections = of(claims, "C04")
    return (f"**Artefacts.** The candy wrapper of LBS does not occur: {sections['within']} of {sections['n']} radii and areas of twisted "
            "cross-sections stay within their bound.")


def shape(results, claims):
    file = results / "error_split" / "limb_twist" / "parts.csv"
    row = only(records.table(file, {"angle_deg", "k_stretch", "iterations", "error_joint_pct", "model_pct"}), file, angle_deg="90",
               k_stretch="0.2", iterations="24")
    return (f"**Shape.** More iterations need not lead to flesh. On a limb twisted by 90 degrees the converged constraints are "
            f"{row.number('model_pct'):.0f} % of the mean bone distance away from the reference, and 24 iterations "
            f"{row.number('error_joint_pct'):.0f} %: what they show is largely the initial guess by LBS.")


def stiffness(results, claims):
    factors = values_of(claims, "C11", "stiffness_ratio_at_twice_iterations")
    return f"**Stiffness.** k is not a stiffness: twice the iterations make flesh {min(factors):.1f} to {max(factors):.1f} times stiffer."


def speed(results, claims):
    rates = values_of(claims, "C10", "frames_per_s")
    return ("**Speed.** Real time holds: at the sizes of Table 1 the paper's own loops reach at least "
            f"{min(rates):.0f} frames per second on one core.")


def lines_of(results):
    claims = sentences.claims_of(results / "claims.json")
    return [f"{number}. {finding(results, claims)}" for number, finding in enumerate((volume, artefacts, shape, stiffness, speed), 1)]


if __name__ == "__main__":
    sys.exit(readme_part.main("findings", lines_of, sys.argv, __doc__))
