"""Records in the layout of a run's directory, with invented numbers that a test can predict."""
import csv
import itertools
import json

revision = "0123456789abcdef0123456789abcdef01234567"


def write_table(file, rows):
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)


def write_origin(folder, of=revision, **more):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "run.json").write_text(json.dumps({**more, "provenance": {"version": "0.1.0", "git_revision": of,
                                                                        "git_dirty": False}}))


def write_run(folder, frames=37, last_angle_deg=180.0):
    """last_angle_deg None: a clip. LBS changes the volume by -angle / 10 %, PBS by a hundredth over its iterations."""
    write_origin(folder, scene={"reference": {"name": "fem_p2"}})
    rows = []
    for frame in range(frames):
        angle = (last_angle_deg or 90.0) * frame / (frames - 1)
        specs = [("lbs", "", "default", -angle / 10), ("dqs", "", "default", angle / 20),
                 ("fem_p2", "", "default", angle / 5)]
        specs += [("pbs", count, "default", -angle / 1000 / count)
                  for count in (1, 24, 96)] + [("pbs", 24, "jiggle", -angle / 500)]
        rows += [{"scene": folder.name, "deformer": deformer, "variant": variant, "iterations": iterations,
                  "frame": frame, "time_s": frame / 100, "volume_change_pct": change,
                  "volume_abs_change_pct": abs(change), "inverted_tets": 0, "min_section_pct": 100 + change,
                  "angle_deg": angle if last_angle_deg else ""}
                 for deformer, iterations, variant, change in specs]
    write_table(folder / "metrics.csv", rows)


def write_frame_statistics(folder, deformer, *iterations, **figures):
    """A row for each number of iterations; p10, median and p90 of the change of volume are -3, -2 and -1 %."""
    shown = {"volume_change_p10_pct": -3.0, "volume_change_median_pct": -2.0, "volume_change_p90_pct": -1.0,
             "volume_abs_change_p10_pct": 1.0, "volume_abs_change_median_pct": 2.0, "volume_abs_change_p90_pct": 3.0,
             "error_joint_least_pct": "", "error_joint_median_pct": "", "error_joint_most_pct": ""} | figures
    write_table(folder / "frame_statistics.csv",
                [{"deformer": deformer, "variant": "default", "iterations": count, "frames": 50} | shown
                 for count in iterations])


def write_study(results):
    """Two sweeps and a clip; in one bone and one joint of the human, LBS changes the volume by -1 %, the others by
    less."""
    study = results / "volume"
    write_run(study / "limb_twist")
    write_run(study / "limb_bend", frames=31, last_angle_deg=150.0)
    write_run(study / "human_01_01", frames=50, last_angle_deg=None)
    write_frame_statistics(study / "human_01_01", "pbs", 1, 24, 96)
    write_table(study / "regions.csv", [
        {"run": "human_01_01", "deformer": deformer, "kind": kind, "bone": "spine", "second_bone": second,
         "rest_share_pct": 10.0, "change_pct": change, "own_change_pct": 10 * change}
        for deformer, change in (("lbs", -1.0), ("dqs", -0.75), ("pbs", -0.125), ("nh_p1", -0.25))
        for kind, second in (("bone", ""), ("joint", "chest"))])


def write_verification(results):
    """Errors h^(p + 1) and h^p of P1 and P2, and one benchmark, coarse and fine, of each."""
    folder = results / "verification"
    write_origin(folder / "beam")
    columns = ("problem", "quantity", "setting", "description", "element_order", "formulation", "material", "poisson",
               "mesh", "h_m", "dofs", "value", "reference", "unit", "difference_pct", "source", "bound_from", "low",
               "high", "observed_order", "expected_order", "note", "holds")
    of_all = dict.fromkeys(columns, "") | {"formulation": "displacement", "material": "linear", "poisson": 0.3}
    rows = []
    for order in (1, 2):
        rows += [{"problem": "manufactured_solution", "quantity": norm, "element_order": order, "h_m": h, "dofs": 1 / h,
                  "value": h ** (order + gain)}
                 for h in (0.5, 0.25, 0.125) for norm, gain in (("error_l2", 1), ("error_h1_seminorm", 0))]
        rows += [{"problem": "cantilever", "quantity": "tip_deflection", "element_order": order, "h_m": 1, "dofs": dofs,
                  "value": 1, "reference": 1, "difference_pct": difference}
                 for dofs, difference in ((10, -30.0), (20, -10.0 / order ** 4))]
    rows += [{"problem": problem, "quantity": "deflection", "description": "largest deflection", "element_order": 1,
              "h_m": 1, "dofs": 9, "value": 2, "reference": 1, "source": "closed form: a beam", "low": 0.5, "high": 1.5,
              "holds": holds}
             for problem, holds in (("beam", "yes"), ("sphere", "no"))]
    write_table(folder / "verification.csv", [of_all | row for row in rows])


comparison_ms = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
# What a method takes, and its share of LBS's error within these times, the last ones; in the table `guessed` half as
# much again if it takes flesh.
compared = {
    "lbs": ("", [1.0] * 8), "dqs": ("", [0.86] * 8), "delta_mush": ("", [1.11, 0.86, 0.78, 0.75, 0.75, 0.75, 0.75]),
    "direct_delta_mush": ("", [1.2] * 7), "pbs": ("", [0.8, 0.63, 0.57, 0.52, 0.48, 0.47]),
    "xpbd": ("material", [0.8, 0.6, 0.53, 0.53, 0.54, 0.54]),
    "quasi_newton": ("material attachment start", [0.6, 0.32, 0.25, 0.22, 0.19]),
    "vbd": ("material attachment start", [0.62, 0.34, 0.27, 0.22, 0.20]),
    "xpbd_neo_hookean": ("material attachment start", [0.7, 0.45, 0.32, 0.24, 0.21]),
    "projective_dynamics": ("material attachment start", [0.75, 0.67, 0.55, 0.45, 0.42])}


def share_of(method, table, ms):
    """None where it is too slow."""
    takes, shares = compared.get(method, ("", compared["pbs"][1]))
    before = len(comparison_ms) - len(shares)
    place = comparison_ms.index(ms) - before
    return None if place < 0 else shares[place] * (1.5 if takes and table == "guessed" else 1.0)


def decided(first, second, of):
    """of: their shares. Level within a tenth, open within a quarter; quasi-Newton and VBD depend on the attachment."""
    if {first, second} == {"quasi_newton", "vbd"}:
        return "depends"
    ratio = max(of) / min(of)
    return ("level" if ratio < 1.1 else "open" if ratio < 1.25 else "first_is_nearer" if of[0] < of[1]
            else "second_is_nearer")


def write_work_precision(results):
    """Ten methods in 40 poses of five bodies, which need 0.7 of each time, except LBS and DQS; 12 mm from flesh with
    LBS. Without the man, it is open whether PBS is nearer than LBS."""
    folder = results / "work_precision"
    runs = ("limb", "human", "played_01_01")
    write_runs(folder, runs)
    (folder / "plan.json").write_text(json.dumps({"extent": "full", "runs": [{"name": run} for run in runs],
                                                  "left_out": []}))
    methods, curves, profiles, pairs, decisions, motion = ([] for _ in range(6))
    for table, ms in itertools.product(("known", "guessed"), comparison_ms):
        names = [*compared, *(["pbs_smooth_weights"] if table == "guessed" else [])]
        shares = {name: share_of(name, table, ms) for name in names if share_of(name, table, ms) is not None}
        place = {"table": table, "budget_ms": ms}
        times = {name: {"lbs": 0.02, "dqs": 0.03}.get(name, 0.7 * ms) for name in shares}
        curves += [place | {"method": name, "setting": f"{name}.iterations={ms:g}", "ms": times[name], "share": share,
                            "share_low": 0.9 * share, "share_high": 1.2 * share} for name, share in shares.items()]
        profiles += [{"table": table, "target_pct": target, "method": name, "budget_ms": ms,
                      "solved_pct": max(0.0, 100 * (1 - share / target * 50))} for target in (20, 35, 50)
                     for name, share in shares.items()]
        if ms not in (0.1, 1.0, 10.0):
            continue
        ranked = sorted(shares, key=shares.get)
        methods += [place | {"method": name, "takes": compared.get(name, ("",))[0],
                             "setting": f"{name}.iterations={ms:g}", "ms": times[name], "times_pbs": 2 * times[name],
                             "within": "doubled" if 2 * times[name] <= ms else "once", "poses": 40, "fewest_poses": 29,
                             "share": shares[name], "share_low": 0.9 * shares[name], "share_high": 1.2 * shares[name],
                             "fold_share": 1.1 * shares[name], "fold_low": shares[name],
                             "fold_high": 1.3 * shares[name], "skin_mm": 12 * shares[name],
                             "inverted_poses": 2 * (name == "pbs_smooth_weights"), "letters": "abcdefghijk"[number]}
                    for number, name in enumerate(ranked)]
        for first, second in itertools.combinations(shares, 2):
            decision = decided(first, second, (shares[first], shares[second]))
            of = place | {"first": first, "second": second}
            decisions += [place | {"without_body": body, "first": first, "second": second,
                                   "decision": "open" if (body, first, second) == ("man", "lbs", "pbs") else decision}
                          for body in ("", "frankie", "human", "lady", "limb", "man")]
            pairs += [of | {"member": member, "wins": wins, "ties": 2, "losses": 38 - wins, "p": p, "p_holm": 5 * p,
                            "ratio": 1.2, "ratio_low": 1.0, "ratio_high": 1.4}
                      for member, wins, p in (("smooth", 30, 0.001 if decision == "depends" else 0.1),
                                              ("nu_0.3", 20, 0.5),
                                              ("rigid_capsules", 4, 0.001 if decision == "depends" else 0.1))]
        if table == "known":
            motion += [{"clip": clip, "budget_ms": ms, "method": name, "setting": "", "member": member, "frames": 6,
                        "ms": times[name], "cold_share": factor * share, "played_share": 0.5 * factor * share,
                        "cold_skin_mm": 12 * factor * share, "played_skin_mm": 6 * factor * share}
                       for clip in ("01_01", "01_03") for member, factor in (("smooth", 1.0), ("rigid_capsules", 1.5))
                       for name, share in shares.items()]
    tables = {"methods": methods, "curves": curves, "profiles": profiles, "pairs": pairs, "decisions": decisions,
              "motion": motion}
    tables["starts"] = [{"budget_ms": ms, "method": "quasi_newton_of_wrong_material", "of": "quasi_newton", "poses": 12,
                         "share": 0.6, "share_of_setting": 0.3} for ms in (1.0, 10.0)]
    tables["references"] = [{"pose": "man_crouch", "body": body, "stratum": "movement", "member": "smooth",
                             "outcome": outcome, "own_error_pct": own} for body, outcome, own in (
                                                     ("limb", "reached", 0.1), ("human", "reached", 0.3),
                                                     ("man", "reached", 1.4), ("lady", "reached", ""),
                                                     ("frankie", "not_reached", ""))]
    for name, rows in tables.items():
        write_table(folder / f"{name}.csv", rows)


def add_own_deformers(folder, clocks):
    """Deformers of the user's own with these clocks, in the records of write_work_precision: 8 ms, a share of 0.5."""
    with open(folder / "methods.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    with open(folder / "curves.csv", newline="") as stream:
        curves = list(csv.DictReader(stream))
    own = {"table": "known", "budget_ms": 10.0, "setting": "", "ms": 8.0, "share": 0.5, "share_low": 0.4,
           "share_high": 0.6}
    write_table(folder / "methods.csv", rows + [rows[0] | own | {"method": name, "takes": "", "letters": "z"}
                                                for name in clocks])
    write_table(folder / "curves.csv", curves + [own | {"method": name} for name in clocks])
    write_table(folder / "limb" / "points.csv", [{"method": name, "clock": clock} for name, clock in clocks.items()])


def write_bench(results):
    """A step takes c microseconds per constraint, c = 24 for plain, 3 for ordered in f32, twice that in f64; two
    threads give a speedup of 1.5."""
    folder = results / "timing" / "bench"
    write_origin(folder)

    def timing(variant, precision, threads, ms_step):
        single = {} if threads == 1 else {"speedup_by_threads": 1.5}
        return {"variant": variant, "precision": precision, "threads": threads, "ms_step": ms_step,
                "ratio_to_plain": 1.0, "quartiles": {"ms_step": [0.9 * ms_step, 1.1 * ms_step]}, **single}

    def mesh(vertices, edges, tets):
        count = vertices + edges + tets
        results = [timing(variant, precision, threads, 1e-3 * c * scale * count)
                   for variant, c in (("plain", 24.0), ("ordered", 3.0))
                   for precision, scale in (("f32", 1.0), ("f64", 2.0))
                   for threads in (1, 2) if variant == "ordered" or threads == 1]
        return {"mesh": {"vertices": vertices, "edges": edges, "tets": tets}, "results": results, "yardsticks": []}

    (folder / "bench.json").write_text(json.dumps(
        {"schema": 2, "context": {"threads": 2, "iterations": 24},
         "meshes": [mesh(100, 500, 400), mesh(1000, 6000, 5000)],
         "scaling": [{"variant": "ordered", "precision": "f32", "threads": 1, "exponent": 1.0,
                      "interval": [None, None]}]}))


def case(number, holds=True, low=None, high=None, threshold_low=0.95, threshold_high=None, unit="1", excluded=None,
         threshold="0.95 or more", **key):
    """A case of a claim as in claims.json; `limit` is a member like the fields of its key."""
    return {**key, "unit": unit, "value": number, "low": number if low is None else low,
            "high": number if high is None else high, "threshold_low": threshold_low, "threshold_high": threshold_high,
            "threshold": threshold, "n": 1, "holds": holds, "excluded": excluded}


def facts(cases):
    """The counts and numbers that claims.json states of a claim or of a selection of its values."""
    counted = [case for case in cases if case.get("excluded") is None]
    known, held = sorted(case["value"] for case in counted
                         if case["value"] is not None), sum(case["holds"] for case in counted)
    reasons = [case["excluded"] for case in cases if case.get("excluded")]
    return {"held": held, "n": len(counted), "share": held / len(counted) if counted else None,
            "least": known[0] if known else None, "median": known[len(known) // 2] if known else None,
            "most": known[-1] if known else None, "cases": cases, "of": {}, "over": {},
            "excluded_cases": {reason: reasons.count(reason) for reason in reasons}}


def selection(name, cases=(), role="comparison", behaves=True, **others):
    thresholds = [{"low": 0.95, "high": None, "threshold": "0.95 or more"}]
    return {**facts(list(cases)), "name": name, "role": role, "quantities": ["ratio"], "thresholds": thresholds,
            "behaves": behaves, **others}


def claim(name, verdict, cases=(), **others):
    empty = {"statement": "Volume is kept.", "place": "Sec. 4", "study": "volume", "rule": "cases", "reason": "",
             "why_inconclusive": "none",
             "quantities": ["ratio"],
             "thresholds": [{"low": 0.95, "high": None, "threshold": "0.95 or more"}], "source": "Sec. 4",
             "range": "meshes", "case_fields": ["body"], "interval_low": None, "interval_high": None, "chance": None,
             "q": None, "differs": None, "fixed_at": "", "held_out": None, "controls": [], "compared": [],
             "readings": [], "excluded_scenes": [], "thresholds_fixed_at": others.get("fixed_at", ""),
             "short": "volume is kept", "measured": None, "asked": None, "without_body": [], "threshold_ranges": [],
             "missing": [], "runs": [], "titles": {}}
    return {**empty, **facts(list(cases)), "id": name, "verdict": verdict, **others}


def write_claims(results, statement="Volume is kept."):
    """One claim of each kind: that fails on two of three clips, that holds, about printed values, without a control,
    untestable."""
    clips = [case(share, share > 0.95, 0.1, body="human", motion=clip)
             for clip, share in (("01_01", 0.975), ("01_03", 0.4), ("01_05", 0.2))]
    rates = [case(rate, True, rate - 3.0, rate + 7.0, 30.0, None, "1/s", threshold="30 or more", body=body)
             for body, rate in (("man", 233.0), ("frankie", 107.0))]
    printed = [{"quantity": "tets", "model": "Man", "value": 5000.0, "threshold_low": 1.0, "threshold_high": bound,
                "threshold": "1 or more" if bound is None else f"1 to {bound:g}", "holds": holds}
               for bound, holds in ((None, True), (9.0, False))]
    lbs = selection("LBS", [case(0.01, False, body="human", motion="01_01")], "negative_control")
    author = selection("the author's later code", [case(0.99, body="human", motion="01_01")])
    judged = [claim("C02a", "fails", clips, runs=["volume/limb_twist"], quantities=["share_kept"],
                    case_fields=["body", "motion"], interval_low=0.01, interval_high=0.91, chance=0.7, q=1 / 3,
                    fixed_at=revision, controls=[lbs], compared=[author], readings=[selection("ordered f32", clips)]),
              claim("C10a", "holds", rates, quantities=["frames_per_s"],
                    thresholds=[{"low": 30.0, "high": None, "threshold": "30 or more"}],
                    interval_low=0.16, interval_high=1.0, chance=0.001, q=0.03, measured="107 to 233 frames/s",
                    asked="30 or more", differs={"field": "body", "least_at": "man", "least": 1, "most_at": "lady",
                                                 "most": 1}),
              claim("C13", "inconsistent_in_print", printed, rule="printed"),
              claim("C14", "inconclusive", why_inconclusive="control_without_record",
                    controls=[selection("DQS", (), "negative_control", False)]),
              claim("C16", "untestable", rule="untestable", reason="no value is in print")]
    titles = {"share_kept": {"title": "share of frames", "unit": "1"},
              "frames_per_s": {"title": "frames per second", "unit": "1/s"}}
    document = {"schema": 4, "revision": revision, "quantities": titles,
                "claims": [{**one, "statement": statement} for one in judged]}
    (results / "claims.json").write_text(json.dumps(document))


def write_repeated(results):
    """repeated.json as `pbskin reproduce` writes it: one of three numbers of C02a differs, and times are not
    compared."""
    table = {"table": "volume/limb_twist/measurements.csv", "rows": 5, "numbers": 5, "equal": 3,
             "differing": [{"row": "share_kept: human", "column": "value", "first": "0.4", "second": "0.5"}]}
    claims = {"C02a": {"compared": 3, "agree": 2, "text": "1 of 3 numbers differ"},
              "C10a": {"compared": 0, "agree": 0, "text": "83.5 to 176 1/s"}}
    (results / "repeated.json").write_text(json.dumps({
        "schema": 1, "first": "records", "second": "results", "agrees": False, "numbers": 5, "equal": 3,
        "tables": [table], "claims": claims, "only_first": [], "only_second": [], "other_settings": [],
        "other_verdicts": [], "text": "This machine does NOT repeat the record: 1 of 5 numbers differ."}))


def write_timing(results):
    """Two meshes of sizes in the paper, and one of another size."""
    write_origin(results / "timing" / "man")
    rows = [{"mesh": mesh, "variant": variant, "precision": precision, "total_wall_ms": ms * scale,
             "frames_per_s": 1000 / (ms * scale), "paper_frames_per_s": paper, "cpu_model": "a processor"}
            for mesh, ms, paper in (("man", 0.5, 90.5), ("frankie", 1.0, 65.8), ("human_20000", 8.0, ""))
            for variant, precision, scale in (("ordered", "f32", 1.0), ("plain", "f64", 8.0))]
    write_table(results / "timing" / "timing.csv", rows)


def write_runs(study, runs):
    for run in runs:
        write_origin(study / run)


def write_convergence(study):
    """Residuals 1 / (1 + i) and errors of 60 % / (1 + i) from LBS, twice that from the second initial guess and so
    on."""
    paths = {"limb_twist": "twist_90", "limb_bend": "bend_60", "human": "01_01_crouch"}
    write_runs(study, [*paths, "ladder_twist", "ladder_bend"])
    starts = list(enumerate(("lbs", "previous_frame", "rest_pose", "rigid_bind"), 1))
    for run, pose in paths.items():
        for name, column, scale in (("residuals", "combined", 1.0), ("towards", "error_joint_pct", 60.0)):
            write_table(study / run / f"{name}.csv",
                  [{"pose": pose, "order": "ordered", "precision": precision, "k_stretch": k, "start": start,
                    "iteration": i, column: scale * factor / (1 + i)} for factor, start in starts
                   for i in (0, 1, 24, 1000)
                   for precision, k in (("f32", 0.2), ("f64", 0.2), ("f32", 0.9))])
    for run in ("ladder_twist", "ladder_bend"):
        write_table(study / run / "rates.csv",
              [{"vertices": vertices, "order": "ordered", "precision": "f32", "k_stretch": 0.2, "start": start,
                "iterations": 1000, "residual_24": 0.03, "last_residual": 0.01,
                "volume_abs_change_24_pct": 1e3 / vertices, "last_volume_abs_change_pct": 0.25, "error_24_pct": 20.0,
                "last_error_pct": "nan", "iterations_to_volume": 1000 if vertices == 500 else 100,
                "volume_reached": int(vertices > 500)} for vertices in (2000, 500, 1000)
               for start in ("lbs", "rest_pose")])


def write_error_split(study):
    """A solver part of 30 % / n and a model part of 20 %. In the lower panels, flesh held
    by the bind constraint converges in the twist and not in the bend."""
    for motion, angle_deg in (("twist", 90), ("bend", 60)):
        folder = study / f"limb_{motion}_{angle_deg}"
        write_origin(folder)
        pose = {"body": "limb", "motion": motion, "pose": "", "angle_deg": angle_deg}
        write_table(folder / "parts.csv",
              [{**pose, "k_stretch": k, "iterations": n, "error_joint_pct": 25.0, "solver_pct": 30.0 / n,
                "model_pct": 20.0, "discretisation_pct": 5.0, "whole_joint_pct": 25.0, "masked_share_pct": 0.0,
                "observed_order": 1.0}
               for k in (0.2, 0.9) for n in (1, 24)])
        held = [("neo_hookean", "smooth", 10, 0.7, 20.0), ("neo_hookean", "embedded", 1e4, 0.35, 30.0),
                ("neo_hookean", "bind", "", "", 80.0 if motion == "twist" else "nan"),
                ("linear", "smooth", 10, 0.7, 40.0)]
        write_table(folder / "attachments.csv",
              [{**pose, "k_stretch": 0.2, "reference": f"{model}_{attachment}", "model": model,
                "attachment": attachment, "spring_factor": factor, "core_radius": core, "difference_pct": 9.0,
                "model_pct": pct}
               for model, attachment, factor, core, pct in held])


def write_artefacts(study):
    """Sections every 10 cm: LBS leaves half of the area, DQS has a tenth more, PBS and the elements keep all; on
    another mesh the area is zero."""
    cases = {"limb_twist": ("twist_90_deg", "twist_180_deg"), "limb_bend": ("bend_60_deg", "bend_90_deg"),
             "human_twist_forearm_upper.L": ("twist_90_deg",), "human_bend_shin.L": ("bend_90_deg",)}
    areas = {"lbs": 0.5, "dqs": 1.1, "pbs": 1.0, "nh_p1": 0.9, "nh_p2": 1.0, "delta_mush": 1.0}
    for case, poses in cases.items():
        write_origin(study / case)
        write_table(study / case / "profiles.csv",
              [{"body": "limb", "vertices": vertices, "pose": pose, "joint": "a|b", "deformer": deformer,
                "order": order, "precision": "f32" if order else "", "offset_m": offset,
                "area_over_rest": area if vertices == 1780 and order != "plain" else 0}
               for pose in poses for deformer, area in areas.items()
               for order in (("ordered", "plain") if deformer == "pbs" else ("",))
               for vertices in (1204, 1780) if (deformer, vertices) != ("delta_mush", 1204)
               for offset in (0.1, -0.1, 0.0)])


def write_stability(study):
    """Every outcome once in the maps; in the cells one factor for two methods."""
    outcomes = ["converged", "bounded", "inverted", "diverged", "not_finite", "converged"]
    maps = {"map_time_step_k_stretch": ("time_step", "s", "k_stretch", "1"),
            "map_iterations_twist": ("iterations", "1", "twist", "deg")}
    write_origin(study / "pbs_maps")
    write_table(study / "pbs_maps" / "cells.csv",
                [{"factor": "time_step", "second_factor": "k_stretch", "outcome": "converged"}])
    for name, (factor, unit, second, second_unit) in maps.items():
        write_table(study / f"{name}.csv",
              [{"factor": factor, "value": value, "unit": unit, "second_factor": second, "second_value": other,
                "second_unit": second_unit, "precision": "f32", "outcome": outcome, "steps": 604}
               for (value, other), outcome in zip(itertools.product((1, 10, 100), (0, 90)), outcomes)])
    write_table(study / "cells.csv",
          [{"body": body, "model": model, "factor": "gravity", "value": value, "unit": "g", "named": "",
            "second_factor": "", "precision": "f32", "outcome": "bounded" if value == 1 else "inverted"}
           for body in ("limb", "human") for model in ("pbs", "xpbd") for value in (10, 1)])


def write_jiggle(study):
    """A frequency of 10 Hz that is proportional to the root of k_stretch; with k_stretch 1 the swing is too short."""
    def row(deformer="pbs", k=0.1, step=10, iterations=24):
        return {"deformer": deformer, "k_stretch": k, "time_step_ms": step, "iterations": iterations, "masses": "unit",
                "k_bind": 1, "outcome": "too_short" if k == 1 else "found", "frequency_hz": 10 * (k / 0.1) ** 0.5,
                "frequency_low_hz": 9, "frequency_high_hz": 40, "damping_ratio": 0.5, "damping_low": 0.25,
                "damping_high": 0.75, "young_pa": "nan" if deformer == "pbs" else 1e5}

    write_runs(study, ["limb_jolt", "limb_reference"])
    write_table(study / "limb_jolt" / "responses.csv", [row(), row(k=0.4), row(k=1), row(step=20), row(iterations=6)])
    write_table(study / "limb_reference" / "responses.csv", [row(), row("nh_p1", step=3.4), row("nh_p1", iterations=6)])


def write_stiffness(study):
    """10 N/m per iteration over the time step squared; XPBD 50 N/m; rows that did not converge, have another order or a
    stiffer material are not part of the figure."""
    for body, load in (("bar", "cantilever"), ("limb", "zone"), ("human", "zone")):
        for run, values in (("iterations", (6, 24)), ("time_step", (5, 10)), ("resolution", (300, 600))):
            write_origin(study / f"{run}_{body}")
            rows = []
            for value, method, (seed, converged, young_pa) in itertools.product(
                    values, ("pbs", "xpbd"), ((0, 1, 3e4), (0, 0, 3e4), (3, 1, 3e4), (0, 1, 3e5))):
                n, step = value if run == "iterations" else 24, value if run == "time_step" else 10
                real = 10.0 * n * 100 / step**2 if method == "pbs" else 50.0
                rows.append({"body": body, "load": load, "vertices": value if run == "resolution" else 300,
                             "mesh": "wanted", "method": method, "k_stretch": 0.2, "young_pa": young_pa,
                             "iterations": n, "time_step_ms": step, "order_seed": seed, "by": "linear",
                             "converged": converged, "stiffness_n_m": real if (seed, converged, young_pa) == (0, 1, 3e4)
                             else 1.0})
            write_table(study / f"{run}_{body}" / "stiffness.csv", rows)


def write_momentum(study):
    """Only rounding if masses are weighted, a quarter if they are not; all of it to the bones."""
    masses = {"equal": 1e-6, "unequal": 1e-6, "unequal_by_eq_8_9": 0.25}
    for body in ("limb", "human"):
        write_origin(study / body)
        rows = [{"claim": "C07", "quantity": f"{momentum}_drift{of_pass}" + ("_taken_by_bones" if of == "bind" else ""),
                 "body": body, "order": "plain" if of_pass else "", "precision": precision, "masses": mass,
                 "constraint": of, "value": 1.0 if of == "bind" else drift}
                for mass, drift in masses.items() for of in ("stretch", "volume", "bind")
                for momentum in ("linear", "angular")
                for precision in ("f32", "f64") for of_pass in ("", "_of_a_pass")]
        write_table(study / body / "measurements.csv", rows)


def write_timing_of_sizes(study):
    """A microsecond per vertex with plain loops, an eighth of it in order; one mesh has the size of one of the
    paper's."""
    write_origin(study / "man_1654")
    write_table(study / "timing.csv",
          [{"mesh": f"man_{vertices}", "body": "man", "variant": variant, "precision": precision, "vertices": vertices,
            "tets": 5 * vertices, "total_wall_ms": total, "total_wall_ms_low": total, "total_wall_ms_high": total,
            "paper_ms": 11.0 if vertices == 1654 else "", "paper_ct_ms": 0.52 if vertices == 1654 else "",
            **{f"{part}_ms": total / 5 for part in ("lbs", "bind", "stretch", "volume", "rest")}}
           for vertices in (1654, 20000) for variant, precision, scale in (("plain", "f64", 1), ("plain", "f32", 1),
                                                                           ("ordered", "f32", 8))
           for total in [1e-3 * vertices / scale]])


def write_features(study):
    """Sleep halves the time of a frame of the limb; the human has one more feature."""
    for scene, features in (("limb", ("sleep",)), ("human", ("sleep", "rendered surface"))):
        write_origin(study / f"features_{scene}")
        write_table(study / f"features_{scene}" / "features.csv",
              [{"feature": feature} | {f"{of}_cpu_ms_ratio{part}": factor * (0.5 if feature == "sleep" else 1.5)
                                       for of in ("frame", "step")
                                       for part, factor in (("", 1.0), ("_lower", 0.9), ("_upper", 1.1))}
               for feature in features])


def write_temporal(study):
    """Two frames are compared, and the first has none before it. Another clip is not drawn."""
    guesses = [{"deformer": name, "start": start} for name in ("pbs_author", "delta_mush", "pbs", "quasi_newton", "dqs")
               for start in ("own", "frame_before")]
    write_origin(study / "human_01_01")
    write_table(study / "human_01_01" / "frames.csv",
                [of | {"frame": frame, "jitter_mm": 0.5 if frame else ""} for of in guesses for frame in (0, 25, 26)])
    write_table(study / "summary.csv",
                [of | {"motion": motion, "compared": 2, "error_joint_pct": 5, "worse_than_cold_frames": 1}
                 for of in guesses for motion in ("01_01", "01_03")])
