"""Writes the findings of the README: one statement with its key numbers per line, from the facts in DIR/claims.json and, for the distance
from flesh and the stability, from the tables of these studies. Each finding names its solver.
"""
import records
from words import case_words, sentences
from words.number_words import counted

paper_s_solver = "the paper's own solver (file order, double precision)"
most_exceptions = 2  # named one by one
first_member = "smooth"  # the reference of the other studies


def only(rows, what, **wanted):
    """The only row or fact with these fields."""
    found = [row for row in rows if all(row.get(name) == value for name, value in wanted.items())]
    if len(found) != 1:
        raise records.RecordsMissing(f"{what}: {len(found)} with {wanted}: expected one")
    return found[0]


def of(claims, name):
    return only(claims, "claims.json: claims", id=name)


def counted_units(claims, name):
    """The claim and its units that count; without such units, a sentence that says why in place of them."""
    claim = of(claims, name)
    units = [case for case in sentences.counting(claim) if case["value"] is not None]
    return claim, units, "" if units else f"{name} is {sentences.names[claim['verdict']]}: {'; '.join(sentences.facts(claim))}."


def percent(value):
    return f"{100 * value:.0f} %"


def volume(claims):
    """The shares of frames in the paper's order, by clip, and the range over the other orders and precisions."""
    claim, clips, told = counted_units(claims, "C02a")
    if not told:
        readings = claim["readings"] + [of for of in claim["compared"] if of["name"] == "ordered f32"]
        others = [case["value"] for of in readings for case in sentences.counting(of) if case["value"] is not None]
        shares = "; ".join(f"{case_words.of(case)}: {percent(case['value'])}" for case in clips)
        told = (f"With {paper_s_solver}, PBS with 24 iterations keeps the volume within 0.5 % in this share of the frames: {shares}."
                + (f" In other orders and precisions it is {percent(min(others))} to {percent(max(others))}." if others else ""))
    return f"**Volume.** {told}"


def artefacts(claims):
    """How many joints have neither artefact, and the units that do not hold where they are few."""
    texts, solver = [], f"With {paper_s_solver}, PBS"
    for name, what, where in (("C04", "candy wrapper", "LBS narrows"), ("C05", "bulge", "DQS bulges")):
        claim, units, told = counted_units(claims, name)
        failing = [f"{case_words.of(case)} ({sentences.shown(case)})" for case in units if not case["holds"]]
        more = [f"{len(failing) - most_exceptions} more"] if len(failing) > most_exceptions else []
        exceptions = f", except for {' and '.join(failing[:most_exceptions] + more)}" if failing else ""
        poses = f"{claim['held']} of the {counted(claim['n'], 'pose')} in which {where}"
        texts.append(told or f"{solver} shows no {what} in {poses}{exceptions}.")
        solver = solver if told else "It"
    return f"**Artefacts.** {' '.join(texts)}"


def convergence(claims):
    claim, _, told = counted_units(claims, "C12a")
    if not told:
        told = (f"With {paper_s_solver}, 24 iterations bring the residual within 5 % of its floor in {claim['held']} of "
                f"{counted(claim['n'], 'case')}.")
        volumes = only(claim["compared"], "claims.json: C12a: compared", name="to 0.5 % of absolute volume")
        if volumes["n"]:
            told += (f" 0.5 % of absolute volume is reached with 24 iterations in {volumes['held']} of {volumes['n']} "
                     f"(iterations needed: {sentences.span(sentences.counting(volumes))}).")
    return f"**Convergence.** {told}"


def trials(results, quantity):
    """The trials of PBS that end like this, and all of them, over all bodies and factors."""
    rows = [row for file in sorted((results / "stability").glob("*/measurements.csv")) for row in records.read_rows(file)
            if row["quantity"] == quantity and row["deformer"] == "pbs"]
    records.need(rows, f"{results / 'stability'}: no {quantity} of PBS")
    return sum(round(row.number("value") * row.number("n")) for row in rows), sum(round(row.number("n")) for row in rows)


def stability(results):
    """A bounded body may move on, and one at rest may be elsewhere than the undisturbed one."""
    diverged, every = trials(results, "share_of_cells_diverged")
    moving, _ = trials(results, "share_of_cells_in_motion")
    correct, _ = trials(results, "share_of_cells_at_rest")
    return (f"**Stability.** In the paper's order and the default one, PBS stays bounded in {every - diverged} of {every} trials with "
            f"disturbances, extreme settings and time steps to 1 s. At the end it is at rest in {every - moving}, and as if undisturbed in "
            f"{correct}.")


def stiffness(claims):
    _, units, told = counted_units(claims, "C11")
    factors = [case["value"] for case in units]
    return "**Stiffness.** " + (told or f"k alone does not define a stiffness: with {paper_s_solver}, doubling the iterations makes the "
                                f"flesh {min(factors):.1f} to {max(factors):.1f} times stiffer.")


def speed(claims):
    claim, units, told = counted_units(claims, "C10a")
    compared = of(claims, "C10b")
    table_1 = f", {sentences.span(sentences.counting(compared))} times the rates of Table 1 on a processor of 2014" if compared["n"] else ""
    rates = sentences.span(units).removesuffix(" 1/s")
    return "**Speed.** " + (told or f"At the sizes of Table 1, PBS with {paper_s_solver} reaches {rates} frames per second on one "
                            f"core{table_1}. The bound is {claim['bounds'][0]['low']:.0f}.")


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
    return (f"**Distance from flesh.** In {counted(measured, 'pose')} of the limb and the human, PBS with 24 iterations (ordered, single "
            f"precision) is {spans['pbs']} of the mean bone distance away from neo-Hookean flesh at the joints (LBS {spans['lbs']}, DQS "
            f"{spans['dqs']}, delta mush {spans['delta_mush']}).{left_out} In all {counted(poses, 'pose')}, {notable[0]['members']} "
            f"references with other attachments and Poisson's ratios decide which of two methods is closer in {decided} of the "
            f"{len(notable)} pairs of skinning methods that differ by more than {records.notable_points} percentage points."
            f"{undecided(notable)}")


def lines_of(results):
    claims = sentences.claims_of(results / "claims.json")
    findings = [volume(claims), artefacts(claims), convergence(claims), stability(results), stiffness(claims), speed(claims),
                distance(results)]
    return [f"{number}. {finding}".replace("\u2212", "-") for number, finding in enumerate(findings, 1)]
