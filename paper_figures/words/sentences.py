"""Every sentence about a claim, composed from the facts of claims.json. The README, the report and the figures' pages all use these.

    for claim in sentences.claims_of(results / "claims.json"):
        print(claim["id"], sentences.outcome(claim))
"""
from records import shapes
from words import case_words
from words.number_words import counted, figure, span, span_of_thousandths

names = case_words.tables["verdict"]
trials = case_words.tables["trial"]  # these shares are counts of trials


def claims_of(file):
    """The claims, each with the titles of its quantities; RecordsMissing if the file is missing or has another shape."""
    document = shapes.read(file, shapes.claims)
    return [claim | {"titles": {name: of["title"] for name, of in document["quantities"].items()}} for claim in document["claims"]]


def title(claim, quantity):
    return claim["titles"].get(quantity, case_words.in_plain(quantity))


def with_unit(unit):
    return "" if unit in ("", "1") else f" {unit}"


# The expected values.

def bound(low, high):
    """0.9 to 1.1; 1.05 or more; 0.5 or less; 0; empty without bounds."""
    if low is None and high is None:
        return ""
    if low is None or high is None:
        return f"{low:.4g} or more" if high is None else f"{high:.4g} or less"
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"


def expected(claim):
    """One text for all quantities, or one text for each; none if the claim cannot be tested."""
    if claim["rule"] == "printed":
        return ["each value as the others require"]
    if not claim["bounds"]:
        return []
    if claim["expected"] is not None:
        return [f"{claim['expected']:.4g} % ({bound(claim['bounds'][0]['low'], claim['bounds'][0]['high'])} %)"]
    texts = [bound(of["low"], of["high"]) for of in claim["bounds"]]
    return texts[:1] if len(set(texts)) == 1 else [f"{title(claim, of['quantity'])}: {text}" for of, text in zip(claim["bounds"], texts)]


# Claims about runs of scenes, frame by frame.

def own_runs(claim):
    """The runs judged by the claim's own metric."""
    own = claim["bounds"][0]["quantity"] if claim["bounds"] else None
    return [case for case in claim["cases"] if "frames" in case and case["quantity"] == own]


def is_by_share(claim):
    """Whether the share of frames that hold decides, rather than their mean."""
    return claim["rule"] == "share_within"


def run_text(claim, case):
    name = case_words.run(case)
    if case["sweep"]:
        return f"{name}: {span_of_thousandths([case['least'], case['most']])} % over the angle"
    share = is_by_share(claim)
    return f"{name}: " + with_interval(case["share_of_frames" if share else "mean"], 100 if share else 1)


def with_interval(interval, scale=1):
    if interval["estimate"] is None:
        return "\u2013"
    text = figure(scale * interval["estimate"])
    if None in (interval["low"], interval["high"]):
        return text
    return f"{text} [{figure(scale * interval['low'])}, {figure(scale * interval['high'])}]"


def clips_text(claim, clips):
    if is_by_share(claim):
        return f"{span([case['share_of_frames']['estimate'] for case in clips], 100)} % of the frames within the bound"
    return f"means of {span([case['mean']['estimate'] for case in clips])} %"


def angles_text(case):
    """The angles at which a sweep holds, and its last angle."""
    held = ", ".join(f"{figure(low)} to {figure(high)}" for low, high in case["held_angles_deg"])
    return f"{case_words.run(case)} " + (f"by {held} of {figure(case['last_angle_deg'])}\u00b0" if held else "by no angle")


# Claims about values that a study measured.

def grouped(claim, values, fields):
    """The values by the title of their quantity, with the fields that distinguish its groups."""
    groups = {}
    for value in (value for value in values if "frames" not in value):
        own = all(value.get(field) == wanted for field, wanted in claim["of"].items())
        told = [case_words.of_field(field, value[field]) for field in fields if field in value and not (own and field in claim["of"])]
        groups.setdefault(", ".join([title(claim, value["quantity"]), *told]), []).append(value)
    return groups


def range_of(values):
    known = [value["value"] for value in values if value["value"] is not None]
    return span(known) + with_unit(values[0].get("unit", "")) if known else ""


def range_with_intervals(values):
    """From the smallest to the largest value; in brackets, from the lowest to the highest end of their intervals."""
    known = [value for value in values if value["value"] is not None]
    if not known:
        return "no value"
    own = [value["value"] for value in known]
    ends = [end for value in known for end in (value["low"], value["high"]) if end is not None] or own
    interval = f" [{figure(min(ends))}, {figure(max(ends))}]" if (min(ends), max(ends)) != (min(own), max(own)) else ""
    return f"{span(own)}{interval}{with_unit(values[0]['unit'])}"


def within(claim):
    """States how many values hold."""
    return f"{claim['within']} of {counted(claim['n'], 'value')} " + ("consistent" if claim["rule"] == "printed" else "within the bound")


def farthest(claim, in_short=False):
    """The value farthest outside its bound; in short, without its case. Empty if every value lies within."""
    primary = claim["primary"]
    if primary is None or primary["statistic"] != "value" or claim["within"] == claim["n"]:
        return ""
    words = "" if in_short else case_words.of(primary)
    of = f" of {words}" if words else ""
    value = "not a number" if primary["value"] is None else figure(primary["value"]) + with_unit(primary["unit"])
    return f"farthest: {title(claim, primary['quantity'])}{of} is {value}, expected {bound(primary['bound_low'], primary['bound_high'])}"


# The subjects for which a claim holds.

def subjects(claim):
    """for limb, man (3 of 4 values); not for lady."""
    groups = {"for": [], "not for": []}
    for subject in claim["subjects"]:
        fails, whole = subject["holds"] == "none", subject["within"] == subject["n"]
        share = "" if fails or whole else f" ({subject['within']} of {counted(subject['n'], 'value')})"
        groups["not for" if fails else "for"].append(case_words.of_field(claim["subject"], subject["name"]) + share)
    return "; ".join(f"{words} {', '.join(of)}" for words, of in groups.items() if of)


def outcome(claim, in_short=False):
    """The subjects for which the claim holds, where it does not hold, and by how much; in short, without the case of the farthest value."""
    runs = own_runs(claim)
    if claim["missing"]:
        return f"without records of {', '.join(claim['missing'])}"
    if runs:
        return runs_outcome(claim, runs)
    if claim["rule"] == "printed" and claim["n"]:
        return f"{within(claim)} with the paper\u2019s other values"
    if not claim["subjects"]:
        return claim["reason"] or "; ".join(left_out(claim))
    told = [farthest(claim, in_short)] if claim["verdict"] == "not_reproduced" else []
    return "; ".join([subjects(claim), *filter(None, told)])


def runs_outcome(claim, runs):
    clips = [case for case in runs if not case["sweep"]]
    parts = ["for " + ", ".join(angles_text(case) for case in runs if case["sweep"])] if len(clips) < len(runs) else []
    if clips:
        held = sum(case["holds"] == "whole" for case in clips)
        parts.append(f"for {held} of {counted(len(clips), 'clip')} ({clips_text(claim, clips)})")
    return "; ".join(parts)


def left_out(claim):
    return [f"{of['scene']} is left out: {of['reason']}" for of in claim["left_out"]]


def by_other_metrics(claim):
    """How many runs hold by metrics other than the claim's own."""
    texts = []
    for of in claim["bounds"][1:] if own_runs(claim) else []:
        runs = [case for case in claim["cases"] if case["quantity"] == of["quantity"]]
        held, partly = (sum(case["holds"] == how for case in runs) for how in ("whole", "part"))
        texts.append(f"by {title(claim, of['quantity'])}: {held} of {counted(len(runs), 'run')} within the bound, {partly} in part")
    return texts


def by_other_orders(claim):
    same = [reading_name(reading) for reading in claim["readings"] if reading["same"]]
    texts = [f"the same verdict in {'; '.join(same)}"] if same else []
    for reading in (reading for reading in claim["readings"] if not reading["same"]):
        places = "; ".join(differing(claim, reading))
        texts.append(f"{names[reading['verdict']]} in {reading_name(reading)}, as against {names[reading['own_verdict']]}"
                     + (f" ({places})" if places else ""))
    return texts


def reading_name(reading):
    return f"order {reading['order']} in {case_words.of_field('precision', reading['precision'])}"


def differing(claim, reading):
    """The runs whose extent differs from that in the claim's own order."""
    cases = [reading["cases"][place] for place in reading["differing"] if 0 <= place < len(reading["cases"])]
    return [f"{case_words.run(case)} by {title(claim, case['quantity'])}" for case in cases]


def verdict_in_full(claim):
    """A list of statements: the verdict with its subjects, the farthest value, other metrics and orders, and what was left out."""
    first = outcome(claim, in_short=True) if claim["verdict"] != "not_reproduced" else subjects(claim)
    told = [names[claim["verdict"]] + (f": {first}" if first else "")]
    return told + [text for text in (farthest(claim), *by_other_metrics(claim), *by_other_orders(claim), *left_out(claim)) if text]


def controls(claim, most=4):
    """The first quantities that were measured for comparison, without a bound, from the smallest to the largest value; empty if there are
    none."""
    groups = grouped(claim, claim["controls"], [*claim["of"], *claim["each"]])
    return ", ".join([control_text(of, values) for of, values in groups.items()][:most])


def control_text(of, values):
    """A share of trials as a count out of all of them."""
    known = [value["value"] for value in values]
    quantity = values[0]["quantity"]
    if quantity in trials and None not in known and all("n" in value for value in values):
        held = sum(round(value["value"] * value["n"]) for value in values)
        return f"{held} of {sum(value['n'] for value in values)} trials {trials[quantity]}"
    return f"{of} {span(known)}{with_unit(values[0]['unit'])}"


# One line per claim, for the README.

most_quantities = 3  # quantities named one by one


def measured_in_line(claim):
    """The number by which its runs are judged, or the range of each bounded quantity, and how much of it is as expected."""
    runs = own_runs(claim)
    if runs:  # the range of each sweep; for clips, the number by which they are judged
        clips, partly = [case for case in runs if not case["sweep"]], sum(case["holds"] == "part" for case in runs)
        texts = [run_text(claim, case) for case in runs if case["sweep"]]
        texts += [f"{counted(len(clips), 'clip')}: {clips_text(claim, clips)}"] if clips else []
        return "; ".join([*texts, f"{claim['within']} of {counted(claim['n'], 'run')} within the bound, {partly} in part"])
    if not claim["n"]:
        return ""
    if claim["rule"] == "printed":
        return within(claim)
    if len(expected(claim)) > most_quantities:
        return "; ".join(filter(None, [within(claim), farthest(claim, in_short=True)]))
    values = [case for case in claim["cases"] if "frames" not in case]
    groups = [[value for value in values if value["quantity"] == of["quantity"]] for of in claim["bounds"]]
    return "; ".join([*filter(None, map(range_of, [values] if len(expected(claim)) == 1 else groups)), within(claim)])


def key_number(claim):
    """How many values hold; then the value farthest outside its bound or, if all hold, nearest to it, with its interval, case and bound."""
    primary = claim["primary"]
    if primary is None or primary["statistic"] == "printed":
        return within(claim) if claim["n"] else ""
    by_share = primary["statistic"] == "share_of_frames"
    ends = (None, None) if primary["low"] == primary["high"] else (primary["low"], primary["high"])
    value = with_interval({"estimate": primary["value"], "low": ends[0], "high": ends[1]}, 100 if by_share else 1)
    name = title(claim, primary["quantity"])
    named = {"share_of_frames": "share of frames", "mean": f"mean {name}"}.get(primary["statistic"], name)
    other = "" if primary.get("deformer") == "pbs" or "deformer" in claim["of"] else primary.get("deformer", "")
    place = [primary.get("body", ""), case_words.motion(primary), case_words.of_field("deformer", other)]
    place += [case_words.of_field(field, primary[field]) for field in ("initial_guess", "masses") if field in primary]
    unit = " %" if by_share else with_unit(primary["unit"])
    ends = [end if end is None else 100 * end if by_share else end for end in (primary["bound_low"], primary["bound_high"])]
    expected_of_it = f"expected {bound(*ends)}" + (" %" if by_share else "")
    told = f"{claim['within']} of {claim['n']} within; {named} {value}{unit}"
    return f"{told} ({', '.join(filter(None, place))}), {expected_of_it}" if any(place) else f"{told}, {expected_of_it}"
