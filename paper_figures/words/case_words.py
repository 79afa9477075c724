"""Describes the case of a value in claims.json in words: its body, motion, joint and settings. The key is a set of
fields, which analysis/verdicts/case_record.hpp declares.

    # limb, bend 90°, k_stretch 0.2
    case_words.of({"body": "limb", "motion": "bend", "angle_deg": 90, "k_stretch": 0.2})
"""
import pathlib
import re
import tomllib

from words import looks

# For each field, the words of its values: field -> {value: words}.
tables = tomllib.loads((pathlib.Path(__file__).parent / "words.toml").read_text(encoding="utf-8"))


def number(value):
    return f"{value:.4g}"


def motion(case):
    """bend 90°; 90° or crouch where the key has no motion; clip 01_01, crouch; clip 01_01 at 1 s; clip 01_01;
    elbow flexion and supination."""
    name = case.get("motion")
    if "angle_deg" in case:
        return f"{name or ''} {number(case['angle_deg'])}\u00b0".strip()
    if name is None:
        return in_plain(case.get("pose", ""))
    if "time_s" in case:
        return f"clip {name} at {number(case['time_s'])} s"
    if name == "range_of_motion":
        return in_plain(case.get("pose", name)).replace("+", " and ")
    if "pose" in case:
        fraction = re.sub(r"^(\d+)_(\d+)_", r"\1/\2 ", case["pose"])  # 2/5 of the clip, for 2_5_of_the_clip
        return f"clip {name}, {in_plain(fraction)}"
    return name if name in ("twist", "bend", "turn") else f"clip {name}"


def in_plain(identifier):
    return identifier.replace("_", " ")


def of_field(field, value):
    """Describes one field: {deformer: lbs} becomes LBS."""
    if field == "deformer" and value in looks.listed:
        return looks.of(value).name
    return tables.get(field, {}).get(value, in_plain(str(value)))


def elements(order, formulation):
    """P2 Taylor-Hood. Where there are no finite elements, the order is empty and the formulation names what is in their
    place."""
    return " ".join(part for part in (f"P{order}" if order else "", tables["formulation"][formulation]) if part)


def material(row):
    """stable neo-Hookean, nu = 0.3: the law of a row of verification.csv."""
    return tables["law"].get(row["material"], row["material"]) + (f", nu = {float(row['poisson']):.6g}"
                                                                  if row["poisson"] else "")


def posed(row):
    """limb, bend 90\u00b0; human, clip 01_01, crouch: the case of a row of points.csv."""
    case = {field: row[field] for field in ("body", "motion", "pose") if row[field]}
    return of(case | ({"angle_deg": float(row["angle_deg"])} if row["angle_deg"] else {}))


# The settings of a computation in the order in which they are described, with their words and the scale of their unit.
setting_words = {**{field: ("{}", 1) for field in ("deformer", "variant", "order", "precision", "masses", "load",
                                                   "ladder", "tolerance", "initial_guess")},
                 "constraint": ("{} constraints", 1), "reference": ("compared with {}", 1),
                 "vertices": ("{} vertices", 1), "k_stretch": ("k_stretch {}", 1), "k_bind": ("k_bind {}", 1),
                 "young_pa": ("{} kPa", 1e-3), "iterations": ("{} iterations", 1),
                 "time_step_s": ("steps of {} ms", 1e3), "factor": ("{}", 1), "second_factor": ("{}", 1),
                 "equation": ("Eq. {}", 1), "gradient_of": ("{}", 1), "reading": ("{}", 1), "model": ("{}", 1)}


def settings(case):
    """The settings of the computation, without the body and its motion: k_stretch 0.05 to 1, or the single value."""
    found = []
    for field, (words, scale) in setting_words.items():
        last = case.get("time_step_to_s" if field == "time_step_s" else f"{field}_to")
        values = [value for value in (case.get(field), last) if value is not None] if field in case else []
        if words == "{}":
            shown = [of_field(field.removeprefix("second_"), value) for value in values]
        else:
            shown = [value if isinstance(value, str) else number(scale * value) for value in values]
        if field == "second_factor" and "factor" in case and shown:
            found[-1] += f" and {shown[0]}"
        elif shown:
            found.append(words.format(" to ".join(shown)))
    return [part for part in found if part]


def of(case):
    place = [case.get("body", ""), motion(case), case.get("joint", "")]
    return ", ".join([part for part in place if part] + settings(case))
