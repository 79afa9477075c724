"""Writes the findings of the README: one statement with its key numbers per line, from the facts in DIR/claims.json and, for the distance
from flesh, from DIR/ensemble.
"""
import records
from words import case_words, sentences
from words.number_words import counted

first_member = "smooth"  # the reference of the other studies


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
    records.need(values, f"claims.json: {name}: no value of {quantity}")
    return values


def volume(claims):
    """The clip with the most frames within the bound; sweeps over an angle are not clips."""
    clips = [case for case in of(claims, "C02")["cases"] if case["quantity"] == "volume_change_pct" and not case["sweep"]]
    records.need(clips, "claims.json: C02: no clip with volume_change_pct")
    best, worst = (choose(clips, key=lambda case: case["share_of_frames"]["estimate"]) for choose in (max, min))
    share = best["share_of_frames"]
    return (f"**Volume.** With 24 iterations, PBS keeps the volume within 0.5 % in at most {100 * share['estimate']:.0f} % of the "
            f"frames of a clip (95 % interval {100 * share['low']:.0f} to {100 * share['high']:.0f} %; {case_words.run(best)}). "
            f"In the worst of {len(clips)} runs it is {100 * worst['share_of_frames']['estimate']:.0f} % of the frames "
            f"({case_words.run(worst)}).")


def artefacts(claims):
    """The angles up to which every twisted section holds, and what is left of the radius at the first angle beyond."""
    sections = [case for case in of(claims, "C04")["cases"] if case["value"] is not None]
    failing = [case for case in sections if case["holds"] == "none"]
    first = min((case["angle_deg"] for case in failing), default=float("inf"))
    held = [case for case in sections if case["angle_deg"] < first and case["quantity"] == "smallest_section_radius_over_rest"]
    records.need(held, "claims.json: C04: no section holds at the smallest angle")
    text = (f"**Artefacts.** Up to a twist of {max(case['angle_deg'] for case in held):.0f}\u00b0 PBS shows no candy wrapper: sections "
            f"keep at least {100 * min(case['value'] for case in held):.0f} % of their radius.")
    if failing:
        radii = [case["value"] for case in failing if case["angle_deg"] == first]
        text += f" At {first:.0f}\u00b0 a section of the {failing[0]['body']} collapses to {100 * min(radii):.0f} %."
    return text


def convergence(claims):
    claim = of(claims, "C12")
    return (f"**Convergence.** 24 iterations suffice in {claim['within']} of {claim['n']} cases. In the others, the volume or the residual "
            "needs more to come within its tolerance.")


def stiffness(claims):
    factors = values_of(claims, "C11", "stiffness_ratio_at_twice_iterations")
    return (f"**Stiffness.** k alone does not define a stiffness: doubling the iterations makes the flesh {min(factors):.1f} to "
            f"{max(factors):.1f} times stiffer.")


def speed(claims):
    claim = of(claims, "C10")
    rates = values_of(claims, "C10", "frames_per_s")
    bound = only(claim["bounds"], "claims.json: C10: bounds", quantity="frames_per_s")["low"]
    return (f"**Speed.** At the sizes of Table 1 the method in file order and double precision reaches at least {min(rates):.3g} frames "
            f"per second on one core. The bound is {bound:.0f}; the paper reports 66 to 91 on a processor of its time.")


def first_errors(results):
    """The errors of each deformer against the family's first reference, in the poses in which that reference has a bound on its own
    error; and the number of all poses."""
    errors, files = {}, sorted((results / "ensemble").glob("*/errors.csv"))
    for file in files:
        members = records.table(file.with_name("members.csv"), {"member", "error_bound_pct"})
        if not only(members, f"{file.parent}/members.csv", member=first_member)["error_bound_pct"]:
            continue
        for row in records.table(file, {"member", "deformer", "error_joint_pct"}):
            if row["member"] == first_member:
                errors.setdefault(row["deformer"], []).append(float(row["error_joint_pct"]))
    return errors, len(files)


def undecided(notable):
    """The causes with their counts, as a sentence, or nothing."""
    causes = {"reference_error": "the own error of a reference is too large or not known", "models_disagree": "the references disagree"}
    counts = {text: sum(pair["decision"] == cause for pair in notable) for cause, text in causes.items()}
    parts = [f"in {count} {text}" for text, count in counts.items() if count]
    return f" The others are undecided: {' and '.join(parts)}." if parts else ""


def distance(results):
    """The errors against the family's first reference, and how many of the pairs that differ notably the whole family decides."""
    errors, poses = first_errors(results)
    pairs = records.table(results / "ensemble" / "pairs.csv", {"first", "second", "largest_difference_pct", "members", "decision"})
    notable = [pair for pair in pairs if float(pair["largest_difference_pct"]) > records.notable_points and "fem_linear" not in
               (pair["first"], pair["second"])]
    if not notable or not {"lbs", "dqs", "delta_mush", "pbs"} <= set(errors):
        raise records.RecordsMissing(f"{results / 'ensemble'}: no errors of LBS, DQS, delta mush and PBS, or no pair of them")
    spans = {name: f"{min(errors[name]):.1f} to {max(errors[name]):.1f} %" for name in errors}
    decided = sum(pair["decision"] == "decided" for pair in notable)
    measured = len(errors["pbs"])
    left_out = "" if measured == poses else (f" These errors leave out {counted(poses - measured, 'pose')} in which the reference has no "
                                             "bound on its own error.")
    return (f"**Distance from flesh.** In {counted(measured, 'pose')} of the limb and the human, PBS with 24 iterations is {spans['pbs']} "
            f"of the mean bone distance away from neo-Hookean flesh at the joints (LBS {spans['lbs']}, DQS {spans['dqs']}, delta mush "
            f"{spans['delta_mush']}).{left_out} In all {counted(poses, 'pose')}, {notable[0]['members']} references with other attachments "
            f"and Poisson's ratios decide which of two methods is closer in {decided} of the {len(notable)} pairs of skinning methods that "
            f"differ by more than {records.notable_points} percentage points.{undecided(notable)}")


def lines_of(results):
    claims = sentences.claims_of(results / "claims.json")
    of_claims = [finding(claims) for finding in (volume, artefacts, convergence, stiffness, speed)]
    return [f"{number}. {finding}" for number, finding in enumerate([*of_claims, distance(results)], 1)]
