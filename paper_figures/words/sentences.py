"""Every sentence about a claim, composed from the facts of claims.json. The README, the claims' pages and the report
all use these.

    for claim in sentences.claims_of(results / "claims.json"):
        print(claim["id"], sentences.in_line(claim))

A claim is judged by its cases: 28 of 29 cases hold, share 0.966 [0.822, 0.999]; 0.067 to 1.02, threshold 0.95 or more.
In brackets stands only the interval of the share; ranges over meshes, frames or orders of projection have these names.
"""
import math

from records import shapes
from words import case_words
from words.number_words import counted, figure

names = case_words.tables["verdict"]
kinds = {"holds": ("holds", "hold"), "fails": ("fails", "fail"), "mixed": ("is mixed", "are mixed"),
         "inconsistent_in_print": ("is inconsistent in print", "are inconsistent in print"),
         "not_shown": ("is not shown", "are not shown"), "inconclusive": ("is inconclusive", "are inconclusive"),
         "untestable": ("cannot be tested", "cannot be tested"), "definition": ("is a definition", "are definitions"),
         "not_computable": ("is not computable", "are not computable")}
author = "the author's later code"
holding_share, failing_share, least_cases = 0.95, 0.5, 5  # as in analysis/verdicts/verdict.hpp
most_ranges = 2  # that cross the threshold, named one by one
most_values = 2  # that are printed, likewise


def claims_of(file):
    """The claims, each with the titles of its quantities; RecordsMissing if the file is missing or has another
    shape."""
    document = shapes.read(file, shapes.claims)
    return [claim | {"titles": {name: of["title"] for name, of in document["quantities"].items()}}
            for claim in document["claims"]]


def counts(claims):
    """There are 22 claims: 5 hold, 8 fail, 1 is a definition."""
    numbers = {kind: sum(claim["verdict"] == kind for claim in claims) for kind in kinds}
    parts = [f"{number} {kinds[kind][number != 1]}" for kind, number in numbers.items() if number]
    return f"There {'is' if len(claims) == 1 else 'are'} {counted(len(claims), 'claim')}: {', '.join(parts)}."


def page_of(name):
    """The page C02 serves the claims C02a and C02b."""
    return name.rstrip("abcdefghijklmnopqrstuvwxyz")


# Thresholds and numbers.

def title(claim, quantity):
    return claim["titles"].get(quantity) or case_words.in_plain(quantity or "number")


def with_unit(unit):
    return "" if unit in ("", "1") else f" {unit}"


def threshold(of):
    """The words of claims.json for the threshold of a case: 0.9 to 1.1; 1.05 or more; empty without one."""
    return of["threshold"].replace("-", "\u2212")


def settings_of(of):
    """The settings for which a threshold is, where there are several."""
    return [case_words.of_field(field, value)
            for field, value in of.items() if field not in ("low", "high", "threshold", "quantity")]


def expected(claim):
    """The text of each threshold."""
    if claim["rule"] == "printed":
        return ["each value as the others require"]
    named = [", ".join(settings_of(of) + ([title(claim, of["quantity"])] if "quantity" in of else []))
             for of in claim["thresholds"]]
    return [": ".join(filter(None, [name, threshold(of)])) for name, of in zip(named, claim["thresholds"])]


def shown(case):
    """A number with its unit. A censored one is not a number: > 1,000."""
    if case["value"] is None:
        return "not a number"
    limit = case_words.tables["limit"].get(case.get("limit"), "")
    digits = f"{case['value']:,.0f}" if limit and abs(case["value"]) >= 1000 else figure(case["value"])
    return limit + digits + with_unit(case.get("unit", ""))


def counting(of):
    return [case for case in of["cases"] if case.get("excluded") is None]


def span(cases):
    """From the least to the most: 13 to > 1,000."""
    known = sorted((case for case in cases if case["value"] is not None), key=lambda case: case["value"])
    broken = len(cases) - len(known)
    ends = list(dict.fromkeys(shown(case) for case in (known[:1] + known[-1:])))
    unit = with_unit(known[0].get("unit", "")) if known else ""
    text = " to ".join([*(end.removesuffix(unit) for end in ends[:-1]), *ends[-1:]])
    return "; ".join(filter(None, [text, f"{counted(broken, 'value')} not a number" if broken else ""]))


def parts(of, case):
    """The number of a case for each of its quantities, with the key of the case."""
    if "parts" not in case:
        return [{"quantity": of["quantities"][0]} | case if of["quantities"] else case]
    key = {name: value for name, value in case.items() if name not in ("parts", "limit")}
    return [key | part | {"excluded": case["excluded"]} for part in case["parts"]]


def by_quantity(of):
    """The numbers of the cases that count: quantity -> its numbers."""
    groups = {}
    for part in (part for case in counting(of) for part in parts(of, case)):
        groups.setdefault(part.get("quantity"), []).append(part)
    return groups


def spans(claim, of):
    """From the least to the most of each quantity of a selection."""
    groups = by_quantity(of)
    return "; ".join(span(cases) if len(groups) == 1 else f"{title(claim, quantity)}: {span(cases)}"
                     for quantity, cases in groups.items())


def number_of(claim, quantity):
    return title(claim, quantity) + (f", over that of the {case_words.of(claim['over'])}" if claim["over"] else "")


def numbers(claim):
    """The range of the cases' numbers for each quantity and each threshold: section radius: 0.067 to 1.02, threshold
    0.95 or more."""
    texts = []
    for quantity, cases in by_quantity(claim).items():
        for ends in dict.fromkeys((case["threshold_low"], case["threshold_high"]) for case in cases):
            settings = [settings_of(of) for of in claim["thresholds"]
                        if (of["low"], of["high"]) == ends and of.get("quantity", quantity) == quantity]
            tested = [case for case in cases if (case["threshold_low"], case["threshold_high"]) == ends]
            words = threshold(tested[0])
            name = ", ".join([number_of(claim, quantity), *(settings[0] if settings else [])])
            texts.append(f"{name}: {span(tested)}" + (f", threshold {words}" if words else ""))
    return texts


def crosses(case):
    """Whether a part of the range lies within the threshold and a part outside."""
    least = -math.inf if case["threshold_low"] is None else case["threshold_low"]
    most = math.inf if case["threshold_high"] is None else case["threshold_high"]
    low, high = range_of(case)
    return case["value"] is not None and low <= most and high >= least and not least <= low <= high <= most


def range_of(case):
    """The ends of a range; one without an end on record, as of an iteration that does not arrive, is infinite."""
    return -math.inf if case["low"] is None else case["low"], math.inf if case["high"] is None else case["high"]


def range_text(case):
    low, high = range_of(case)
    return f"{figure(low)} to {'any number' if math.isinf(high) else figure(high)}"


def ranges(claim):
    """The cases whose range crosses the threshold: range over meshes of limb, twist 180 deg: 0.065 to 0.97."""
    found = [case for case in counting(claim) if crosses(case)] if claim["range"] else []
    named = [f"{range_name(claim)} of {case_words.of(case)}: {range_text(case)}" for case in found[:most_ranges]]
    others = len(found) - most_ranges
    return named + ([f"the ranges of {counted(others, 'more case')} cross the threshold"] if others > 0 else [])


def range_name(claim):
    """What low and high of a number span; that of a single number has its whole name on record: 95 % range of the
    fit."""
    over = "" if claim["rule"] == "single" else "range over "
    return over + claim["range"] if claim["range"] else "range"


# How many cases hold.

def share(claim):
    """28 of 29 cases hold, share 0.966 [0.822, 0.999]"""
    text = held(claim, " hold")
    return text if claim["interval_low"] is None or claim["interval_high"] is None else (
        f"{text} [{claim['interval_low']:.3g}, {claim['interval_high']:.3g}]")


def held(of, verb=""):
    """28 of 29 cases, share 0.966; without a threshold only their number; no record without cases."""
    if not of["n"]:
        return "no record" if not of["cases"] else "no case counts"
    if not of["thresholds"]:
        return counted(of["n"], "case")
    known = "" if of["share"] is None else f", share {of['share']:.3g}"
    return f"{of['held']} of {counted(of['n'], 'case')}{verb}{known}"


def excluded_cases(of):
    return [f"{counted(number, 'case')} excluded: {case_words.of_field('excluded', why)}"
            for why, number in of["excluded_cases"].items()]


def by_chance(claim):
    """Where chance decides."""
    decides = claim["verdict"] == "not_shown" or claim["why_inconclusive"] == "chance"
    return ([f"chance alone reaches as many with probability {figure(claim['chance'])}, where less than 0.01 is asked"]
            if decides else [])


def difference(claim):
    """The property by which holding and failing cases differ most."""
    of = claim["differs"]
    if of is None:
        return []
    least, most = (case_words.of_field(of["field"], of[end]) for end in ("least_at", "most_at"))
    return [f"the share differs most by {case_words.of_field('case_field', of['field'])}: {of['least']:.3g} for "
            f"{least}, {of['most']:.3g} for {most}"]


def why_inconclusive(claim):
    """Why the claim is inconclusive or cannot be tested: controls without a record or that misbehave, few cases, or its
    own reason."""
    reason = claim["why_inconclusive"]
    if reason == "too_few_cases" and claim["rule"] == "single" and claim["cases"]:
        return [f"{counted(len(claim['cases']), 'number')} are on record where one is expected"]
    if reason == "too_few_cases":
        return ["no case is on record" if not claim["cases"] else f"only {counted(claim['n'], 'case')}, "
                                                                  "fewer than five"]
    if reason not in ("control_without_record", "control_misbehaves"):
        return [claim["reason"]] if claim["reason"] else []
    none = [control["name"] for control in claim["controls"] if not control["n"]]
    wrong = [f"the {case_words.of_field('role', control['role'])} {control['name']} holds in {control['held']} of "
             f"{counted(control['n'], 'case')}"
             for control in claim["controls"] if control["n"] and not control["behaves"]]
    return [*([f"no record of the control{'s' if len(none) > 1 else ''} {', '.join(none)}"] if none else []), *wrong]


def facts(claim):
    """The statements behind a verdict, the primary number first; without cases, why there are none."""
    if claim["missing"]:
        return [f"no record of {', '.join(claim['missing'])}"]
    if claim["rule"] == "printed":
        if not claim["n"]:
            return ["no record"]
        are_listed = claim["verdict"] == "holds" and claim["n"] <= most_values
        values = [f"{title(claim, case['quantity'])}: {shown(case)}, by the others {figure(case['threshold_low'])} to "
                  f"{figure(case['threshold_high'])}" for case in claim["cases"] if are_listed]
        return [f"{claim['held']} of {counted(claim['n'], 'printed value')} consistent", *values]
    if claim["rule"] in ("definition", "untestable"):
        return [*why_inconclusive(claim), *numbers(claim)]
    if claim["rule"] == "single":
        told = [one_number(claim)] if len(claim["cases"]) == 1 else numbers(claim)
        return [*told, *why_inconclusive(claim), *excluded_scenes(claim)] or ["no record"]
    told = [share(claim), *numbers(claim), *ranges(claim)] if claim["n"] else []
    told += [*excluded_cases(claim), *by_chance(claim), *difference(claim), *why_inconclusive(claim),
             *excluded_scenes(claim)]
    return told or ["no record"]


def in_line(claim):
    """One sentence per fact, for a table or a paragraph; the last one without its full stop."""
    return ". ".join(text[:1].upper() + text[1:] for text in facts(claim))


def one_number(claim):
    """The single number by which a claim is judged, with the range that decides."""
    case, = claim["cases"]
    return (f"{number_of(claim, claim['quantities'][0])}: {shown(case)} ({range_name(claim)}: {figure(case['low'])} to "
            f"{figure(case['high'])}), threshold {threshold(case)}")


def basis(claim):
    """Sentences: what a case is, its number and threshold; chance; when the rule was fixed."""
    if claim["rule"] not in ("cases", "single") or not claim["quantities"]:
        return ""
    fields = ", ".join(case_words.of_field("case_field", field) for field in claim["case_fields"])
    between = " or " if "quantity" in claim["case_fields"] else " and "
    number = between.join(number_of(claim, quantity) for quantity in claim["quantities"])
    thresholds = expected(claim)
    told = [f"The number of a case ({fields}) is the {number}",
            f"The {'threshold is' if len(thresholds) == 1 else 'thresholds are'} {', '.join(thresholds)} "
            f"({claim['source']})"]
    if claim["chance"] is not None:
        told += [f"If each case held with probability q = {figure(claim['q'])}, at least as many would hold by chance "
                 f"with probability {figure(claim['chance'])}",
                 "This q is the share of the negative control, by the rule of succession, or one half"]
    if claim["fixed_at"]:
        told.append(f"Rule and threshold are of revision {claim['fixed_at'][:12]}"
                    if claim["fixed_at"] == claim["thresholds_fixed_at"] else
                    f"The threshold is of revision {claim['thresholds_fixed_at'][:12]}, the rule of revision "
                    f"{claim['fixed_at'][:12]}")
    return ". ".join(told) + "."


def held_out(claim):
    """The verdict on the held-out cases, as a claim; None without them."""
    return claim["held_out"] | {"titles": claim["titles"]} if isinstance(claim["held_out"], dict) else None


def both_verdicts(claim):
    """The verdict, and the one on the held-out cases where there are any: holds; on the held-out cases: fails."""
    later = held_out(claim)
    return names[claim["verdict"]] + (f"; on the held-out cases: {names[later['verdict']]}" if later else "")


def on_held_out_cases(claim):
    """The verdict on the cases that were recorded after the thresholds were fixed, with the facts behind it, or
    nothing."""
    later = held_out(claim)
    mended = "" if claim["fixed_at"] == claim["thresholds_fixed_at"] else " and before the rule was mended"
    return [f"On the held-out cases, which were recorded after the thresholds were fixed{mended}, the verdict is "
            f"{names[later['verdict']]!r}. {in_line(later)}"] if later else []


def in_words(parts):
    """the limb; the limb and the man; the limb, the man and the lady"""
    return " and ".join(filter(None, [", ".join(parts[:-1]), *parts[-1:]]))


def without_a_body(claim):
    """The verdicts that differ if all cases of one body are excluded: one sentence, or none for a claim whose cases
    have no body."""
    if not claim["without_body"]:
        return []
    others = {}
    for of in claim["without_body"]:
        if of["verdict"] != claim["verdict"]:
            others.setdefault(of["verdict"], []).append(of["body"])
    if not others:
        return ["The verdict stays the same if any one body is excluded"]
    changes = [f"{names[kind]!r} without {bodies[0] if len(bodies) == 1 else f'any one of {in_words(bodies)}'}"
               for kind, bodies in others.items()]
    return [f"If one body is excluded, the verdict changes: it is {in_words(changes)}"]


def on_other_tets(claim, meshes):
    """The verdicts on other tets of the human and the limb, of rows of experiments/records/other_tets.csv: one
    sentence, or none."""
    others = [row for row in meshes if row["claim"] == claim["id"] and row["size"] != "1.00"]
    if not others:
        return []
    verdict = same_or_changed("the verdict", claim["verdict"], [row["verdict"] for row in others])
    later = held_out(claim)
    if later:
        verdict += ", and " + same_or_changed("that on the held-out cases", later["verdict"],
                                              [row["held_out"] for row in others])
    sizes = sorted({row["size"] for row in others})
    return [f"On {len(others)} other tet meshes of the human's and the limb's surfaces, "
            f"with {' to '.join([sizes[0], sizes[-1]])} times as many vertices, {verdict}"]


def same_or_changed(what, recorded, verdicts):
    changes = [f"{names[kind]!r} on {verdicts.count(kind)}" for kind in dict.fromkeys(verdicts) if kind != recorded]
    return f"{what} changes: it is {in_words(changes)} of them" if changes else f"{what} is the same"


other_tets_head = ["vertices wanted", "human: vertices", "limb: vertices", "verdict", "on the held-out cases",
                   "cases that hold", "values of human and limb"]


def other_tets_rows(claim, meshes):
    """A row for each mesh, that of the record (1.00) among them, with the values of human and limb alone."""
    rows = []
    for row in meshes:
        if row["claim"] == claim["id"]:
            unit = "" if row["unit"] == "1" else f" {row['unit']}"
            size = "as on the record" if row["size"] == "1.00" else f"{row['size']} times"
            rows.append([size, row["human_vertices"], row["limb_vertices"], names[row["verdict"]],
                         names.get(row["held_out"], "\u2013"), f"{row['holding']} of {row['cases']}",
                         f"{figure(float(row['least']))} to {figure(float(row['most']))}{unit}"])
    return rows


def threshold_ranges(claim):
    """For each end of a threshold, the range over which the verdict is the same: one sentence each."""
    texts = []
    for of in claim["threshold_ranges"]:
        settings = settings_of({name: value for name, value in of.items() if name not in ("end", "threshold")})
        what = ", ".join(settings + ([title(claim, of["quantity"])] if "quantity" in of else []))
        low, high = (None if of[end] is None else figure_of_four(of[end]) for end in ("low", "high"))
        others = (f" from {low} to {high}" if low and high else f" from {low} on" if low else f" up to {high}" if high
                  else "")
        end = {"low": "lower", "high": "upper"}[of["end"]]
        texts.append(f"With any {end} threshold{f' of the {what}' if what else ''}{others} in place of "
                     f"{figure_of_four(of['threshold'])}, the verdict is the same")
    return texts


def figure_of_four(value):
    """Four digits, as the numbers at which a verdict turns are often close to each other."""
    return f"{value:.4g}".replace("-", "\u2212")


def excluded_scenes(claim):
    return [f"{of['scene']} is excluded: {of['reason']}" for of in claim["excluded_scenes"]]


# Controls, comparisons and readings: the rows of tables.

control_head = ["control", "role", "cases that hold", "numbers", "as it must"]
compared_head = ["for comparison", "cases within the threshold", "numbers"]
reading_head = ["order and precision of projection", "cases within the threshold", "least", "most"]


def named(claim, of):
    """A selection with the title of its quantity, where that is not the claim's own: LBS (time of LBS per frame)."""
    if of["quantities"] == claim["quantities"] or not of["quantities"]:
        return of["name"] or "not recorded"
    titles = " and ".join(title(claim, name) for name in of["quantities"])
    return titles if of["name"] in titles else f"{of['name']} ({titles})"


def control_rows(claim):
    return [[named(claim, of), case_words.of_field("role", of["role"]), held(of), spans(claim, of),
             "yes" if of["behaves"] else "no"]
            for of in claim["controls"]]


def compared_rows(claim):
    return [[named(claim, of), held(of), spans(claim, of)] for of in claim["compared"]]


def reading_rows(claim):
    def ends(of):
        known = sorted((case for case in counting(of) if case["value"] is not None), key=lambda case: case["value"])
        return [shown(known[0]), shown(known[-1])] if known else ["", ""]

    return [[named(claim, of), held(of), *ends(of)] for of in claim["readings"]]


def extent(holding):
    """How far cases hold, by the rule's own limits of a share."""
    share = sum(holding) / len(holding)
    return ("throughout" if share >= holding_share else "in half of the cases or fewer" if share <= failing_share else
            "in more than half of the cases")


def by_case(claim, of):
    """Whether each case that counts holds, by its key."""
    return {tuple(case.get(field) for field in claim["case_fields"]): case["holds"] for case in counting(of)}


def disagreements(claim):
    """One sentence for each order, and for the author's later code, that disagrees with the claim's own reading. Only
    cases with a number in both are compared, and only if there are at least five."""
    sentences, own = [], by_case(claim, claim) if claim["rule"] == "cases" else {}
    for other in claim["readings"] + [compared for compared in claim["compared"] if compared["name"] == author]:
        pairs = [(own[case], holds) for case, holds in by_case(claim, other).items() if case in own]
        if len(pairs) < least_cases:
            continue
        extent_of_own, extent_of_other = (extent(holding) for holding in zip(*pairs))
        if extent_of_own != extent_of_other:
            sentences.append(f"{other['name'][:1].upper()}{other['name'][1:]} and the claim's own reading disagree: "
                             f"in the {len(pairs)} cases that both have, the threshold holds {extent_of_other} in the "
                             f"one, {extent_of_own} in the other.")
    return sentences
