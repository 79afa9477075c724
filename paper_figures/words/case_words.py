"""Describes the case of a value in claims.json in words: its body, motion, joint and settings. The key is a set of fields, which
analysis/verdicts/case_record.hpp declares.

    case_words.of({"body": "limb", "motion": "bend", "angle_deg": 90, "k_stretch": 0.2})  # limb, bend 90°, k_stretch 0.2
"""
import re

from words import looks

limbs = {"twist": "limb twisted", "bend": "limb bent"}  # whole sweeps
precisions = {"f32": "single precision", "f64": "double precision"}
masses = {"equal": "equal masses", "unequal": "unequal masses", "unequal_by_eq_8_9": "unequal masses by Eq. 8\u20139, which are for m = 1",
          "unit": "unit masses", "lumped": "lumped masses"}
tolerances = {"residual": "tolerance on the residual", "volume": "tolerance on the volume"}
guesses = {"previous_frame": "from the previous frame", "rest_pose": "from the rest pose", "rigid_bind": "from the rigid bind"}
readings = {"as_printed": "as printed", "relative_to_p1": "read relative to p1", "derived_gradients": "with the derived gradients"}
variants = {"jiggle": "jiggling flesh"}
formulations = {"displacement": "", "mean_dilatation": "mean dilatation", "taylor_hood": "Taylor-Hood", "pbs": "PBS",
                "volume_constraints": "PBS, every volume kept", "one_point": "one point", "two_grids": "two grids"}
factors = {"poisson": "Poisson\u2019s ratio", "young": "Young\u2019s modulus", "slivers_height_kept": "slivers, height kept",
           "needles_edge_kept": "needles, edge kept", "sign_k_bind": "sign, k_bind",
           **{name: name for name in ("k_stretch", "k_volume", "k_bind")}}
laws = {"stable_neo_hookean": "stable neo-Hookean", "neo_hookean": "neo-Hookean", "isochoric_neo_hookean": "isochoric neo-Hookean",
        "st_venant_kirchhoff": "St Venant\u2013Kirchhoff"}
features = {"stop_residual_0.1": "stop_residual of 0.1",
            "error_bar_of_the_reference_orders": "error bar of the reference from the other element order"}
limits = {"at_least": "at least ", "at_most": "at most ", "more_than": "more than "}


def number(value):
    return f"{value:.4g}"


def in_range(case, field, words):
    """k_stretch 0.05 to 1, or the single value. words: a format with {} for the range."""
    first, last = case.get(field), case.get(f"{field.removesuffix('_s')}_to{'_s' if field.endswith('_s') else ''}")
    if first is None:
        return ""
    return words.format(number(first) if last is None else f"{number(first)} to {number(last)}")


def motion(case):
    """bend 90°; clip 01_01, crouch; clip 01_01 at 1 s; clip 01_01."""
    name = case.get("motion")
    if name is None:
        return ""
    if "angle_deg" in case:
        return f"{name} {number(case['angle_deg'])}\u00b0"
    if "time_s" in case:
        return f"clip {name} at {number(case['time_s'])} s"
    if "pose" in case:
        return f"clip {name}, {pose_words(case['pose'])}"
    return name if name in (*limbs, "turn") else f"clip {name}"


def pose_words(pose):
    """in the air; 2/5 of the clip, for 2_5_of_the_clip."""
    return in_plain(re.sub(r"^(\d+)_(\d+)_", r"\1/\2 ", pose))


def in_plain(identifier):
    return identifier.replace("_", " ")


def of_field(field, value):
    """Describes one field: {deformer: lbs} becomes LBS."""
    known = {"deformer": {name: looks.of(name).name for name in looks.listed}, "precision": precisions, "masses": masses,
             "tolerance": tolerances, "initial_guess": guesses, "reading": readings, "variant": variants, "factor": factors,
             "feature": features}
    return known.get(field, {}).get(value, in_plain(str(value)))


def elements(order, formulation):
    """P2 Taylor-Hood. Where there are no finite elements, the order is empty and the formulation names what is in their place."""
    return " ".join(part for part in (f"P{order}" if order else "", formulations[formulation]) if part)


def material(row):
    """stable neo-Hookean, nu = 0.3: the law of a row of verification.csv."""
    return laws.get(row["material"], row["material"]) + (f", nu = {float(row['poisson']):.6g}" if row["poisson"] else "")


def posed(row):
    """limb, bend 90\u00b0; human, clip 01_01, crouch: the case of a row of points.csv."""
    case = {field: row[field] for field in ("body", "motion", "pose") if row[field]}
    return of(case | ({"angle_deg": float(row["angle_deg"])} if row["angle_deg"] else {}))


def settings(case):
    """The settings of the computation, without the body and its motion."""
    of = [of_field(field, case[field]) for field in ("deformer", "variant", "order", "precision", "masses", "load", "ladder", "tolerance",
                                                     "initial_guess") if field in case]
    of += [f"{case['constraint']} constraints"] if "constraint" in case else []
    of += [f"compared with {case['reference']}"] if "reference" in case else []
    of += [in_range(case, "vertices", "{} vertices"), in_range(case, "k_stretch", "k_stretch {}"), in_range(case, "k_bind", "k_bind {}")]
    of += [f"{number(case['young_pa'] / 1000)} kPa"] if "young_pa" in case else []
    of += [in_range(case, "iterations", "{} iterations")]
    step_ms = {name: case[name] * 1000 for name in ("time_step_s", "time_step_to_s") if name in case}
    of += [in_range(step_ms, "time_step_s", "steps of {} ms")]
    of += [" and ".join(of_field("factor", case[field]) for field in ("factor", "second_factor") if field in case)]
    of += [f"Eq. {case['equation']}"] if "equation" in case else []
    of += [of_field(field, case[field]) for field in ("gradient_of", "reading", "model") if field in case]
    return [part for part in of if part]


def of(case):
    place = [case.get("body", ""), motion(case), case.get("joint", "")]
    return ", ".join([part for part in place if part] + settings(case))


def run(case):
    """A judged run of a scene: limb twisted; human, clip 01_01, jiggling flesh."""
    if case.get("body") == "limb" and case.get("motion") in limbs:
        name = limbs[case["motion"]]
    else:
        name = ", ".join(part for part in (case.get("body", ""), motion(case)) if part)
    return name + (f", {of_field('variant', case['variant'])}" if "variant" in case else "")
