"""Tables of the studies that plots show, in their columns, with invented numbers that a test can predict."""
import itertools

from synthetic_records import write_origin, write_table


def write_runs(study, runs):
    for run in runs:
        write_origin(study / run)


def write_convergence(study):
    """Residuals 1 / (1 + i) and errors of 60 % / (1 + i) from LBS, twice that from the second initial guess and so on."""
    paths = {"limb_twist": "twist_90", "limb_bend": "bend_60", "human": "01_01_crouch"}
    write_runs(study, [*paths, "ladder_twist", "ladder_bend"])
    starts = list(enumerate(("lbs", "previous_frame", "rest_pose", "rigid_bind"), 1))
    for run, pose in paths.items():
        for name, column, scale in (("residuals", "combined", 1.0), ("towards", "error_joint_pct", 60.0)):
            write_table(study / run / f"{name}.csv",
                  [{"pose": pose, "order": "ordered", "precision": precision, "k_stretch": k, "start": start, "iteration": i,
                    column: scale * factor / (1 + i)} for factor, start in starts for i in (0, 1, 24, 1000)
                   for precision, k in (("f32", 0.2), ("f64", 0.2), ("f32", 0.9))])
    for run in ("ladder_twist", "ladder_bend"):
        write_table(study / run / "rates.csv",
              [{"vertices": vertices, "order": "ordered", "precision": "f32", "k_stretch": 0.2, "start": start, "iterations": 1000,
                "residual_24": 0.03, "last_residual": 0.01, "volume_abs_change_24_pct": 1e3 / vertices, "last_volume_abs_change_pct": 0.25,
                "error_24_pct": 20.0, "last_error_pct": "nan", "iterations_to_volume": 1000 if vertices == 500 else 100,
                "volume_reached": int(vertices > 500)} for vertices in (2000, 500, 1000) for start in ("lbs", "rest_pose")])


def write_error_parts(study):
    """A solver part of 30 % / n and a model part of 20 %; rows with other k_stretch, orders, substeps and meshes are not part of the
    figure."""
    write_origin(study / "limb_twist_90")
    settings = [("ordered", 0.2, 1, ""), ("plain", 0.2, 1, ""), ("ordered", 0.9, 1, ""), ("ordered", 0.2, 2, ""), ("ordered", 0.2, 1, 300)]
    write_table(study / "limb_twist_90" / "points.csv",
          [{"body": "limb", "motion": "twist", "pose": "", "angle_deg": 90, "deformer": "pbs", "iterations": n, "k_stretch": k,
            "order": order, "precision": "f32", "packed": 1, "outcome": "finished", "substeps": substeps,
            "wanted_vertices": vertices, "error_joint_pct": 25.0, "solver_pct": 30.0 / n, "model_pct": 20.0, "discretisation_pct": 5.0}
           for n in (1, 24, 384) for order, k, substeps, vertices in settings])
    write_table(study / "omissions.csv", [{"comparison": "packed_f32", "case": "limb_twist_90", "deformer": "pbs", "why": "over_time_limit",
                                     "missing": 1, "points": 15, "reason": ""}])


def write_improvements(study):
    """PBS with an error of 40 % / n, and smooth weights with half of it, which gain half of PBS's error at each budget, decided at 24
    iterations alone."""
    write_origin(study / "limb_twist_90")
    write_table(study / "limb_twist_90" / "changes.csv", [{"change": "pbs"}])
    write_table(study / "curves.csv", [{"body": "limb", "change": change, "setting": "", "iterations": n, "poses": 1, "mean_ms": 0.1 * n,
                                  "error_joint_pct": factor * 40.0 / n}
                                 for change, factor in (("pbs", 1.0), ("smooth_weights", 0.5)) for n in (1, 4, 24, 96)])
    write_table(study / "gains.csv", [{"group": "all", "budget_iterations": n, "change": "smooth_weights", "than": than, "poses": 1,
                                 "gain_pct": 20.0 / n, "gain_low_pct": 19.0 / n, "gain_high_pct": 21.0 / n,
                                 "decision": "decided" if n == 24 else "few_poses"}
                                for n in (4, 24, 96) for than in ("pbs", "k_by_edge_length")])


def write_error_split(study):
    """As above; in the lower panels, flesh held by the bind constraint converges in the twist and not in the bend."""
    for motion, angle_deg in (("twist", 90), ("bend", 60)):
        folder = study / f"limb_{motion}_{angle_deg}"
        write_origin(folder)
        pose = {"body": "limb", "motion": motion, "pose": "", "angle_deg": angle_deg}
        write_table(folder / "parts.csv",
              [{**pose, "k_stretch": k, "iterations": n, "error_joint_pct": 25.0, "solver_pct": 30.0 / n, "model_pct": 20.0,
                "discretisation_pct": 5.0} for k in (0.2, 0.9) for n in (1, 24)])
        held = [("neo_hookean", "smooth", 10, 0.7, 20.0), ("neo_hookean", "embedded", 1e4, 0.35, 30.0),
                ("neo_hookean", "bind", "", "", 80.0 if motion == "twist" else "nan"), ("linear", "smooth", 10, 0.7, 40.0)]
        write_table(folder / "attachments.csv",
              [{**pose, "k_stretch": 0.2, "reference": f"{model}_{attachment}", "model": model, "attachment": attachment,
                "spring_factor": factor, "core_radius": core, "model_pct": pct} for model, attachment, factor, core, pct in held])


def write_artefacts(study):
    """Sections every 10 cm: LBS leaves half of the area, DQS has a tenth more, PBS and the elements keep all; on another mesh the area is
    zero."""
    cases = {"limb_twist": ("twist_90_deg", "twist_180_deg"), "limb_bend": ("bend_60_deg", "bend_90_deg"),
             "human_twist_forearm_upper.L": ("twist_90_deg",), "human_bend_shin.L": ("bend_90_deg",)}
    areas = {"lbs": 0.5, "dqs": 1.1, "pbs": 1.0, "nh_p1": 0.9, "nh_p2": 1.0, "delta_mush": 1.0}
    for case, poses in cases.items():
        write_origin(study / case)
        write_table(study / case / "profiles.csv",
              [{"body": "limb", "vertices": vertices, "pose": pose, "joint": "a|b", "deformer": deformer, "order": order,
                "precision": "f32" if order else "", "offset_m": offset,
                "area_over_rest": area if vertices == 1780 and order != "plain" else 0}
               for pose in poses for deformer, area in areas.items() for order in (("ordered", "plain") if deformer == "pbs" else ("",))
               for vertices in (1204, 1780) if (deformer, vertices) != ("delta_mush", 1204) for offset in (0.1, -0.1, 0.0)])


def write_stability(study):
    """Every outcome once in the maps; in the cells one factor for two methods."""
    outcomes = ["converged", "bounded", "inverted", "diverged", "not_finite", "converged"]
    maps = {"map_time_step_k_stretch": ("time_step", "s", "k_stretch", "1"), "map_iterations_twist": ("iterations", "1", "twist", "deg")}
    write_origin(study / "pbs_maps")
    for name, (factor, unit, second, second_unit) in maps.items():
        write_table(study / f"{name}.csv",
              [{"factor": factor, "value": value, "unit": unit, "second_factor": second, "second_value": other, "second_unit": second_unit,
                "precision": "f32", "outcome": outcome, "steps": 604}
               for (value, other), outcome in zip(itertools.product((1, 10, 100), (0, 90)), outcomes)])
    write_table(study / "cells.csv",
          [{"body": body, "model": model, "factor": "gravity", "value": value, "unit": "g", "named": "", "second_factor": "",
            "precision": "f32", "outcome": "bounded" if value == 1 else "inverted"}
           for body in ("limb", "human") for model in ("pbs", "xpbd") for value in (10, 1)])


def write_jiggle(study):
    """A frequency of 10 Hz that is proportional to the root of k_stretch; with k_stretch 1 the swing is too short."""
    def row(deformer="pbs", k=0.1, step=10, iterations=24):
        return {"deformer": deformer, "k_stretch": k, "time_step_ms": step, "iterations": iterations, "masses": "unit", "k_bind": 1,
                "outcome": "too_short" if k == 1 else "found", "frequency_hz": 10 * (k / 0.1) ** 0.5, "frequency_low_hz": 9,
                "frequency_high_hz": 40, "damping_ratio": 0.5, "damping_low": 0.25, "damping_high": 0.75,
                "young_pa": "nan" if deformer == "pbs" else 1e5}

    write_runs(study, ["limb_jolt", "limb_reference"])
    write_table(study / "limb_jolt" / "responses.csv", [row(), row(k=0.4), row(k=1), row(step=20), row(iterations=6)])
    write_table(study / "limb_reference" / "responses.csv", [row(), row("nh_p1", step=3.4), row("nh_p1", iterations=6)])


def write_stiffness(study):
    """10 N/m per iteration over the time step squared; XPBD 50 N/m; rows that did not converge, have another order or a stiffer material
    are not part of the figure."""
    for body, load in (("bar", "cantilever"), ("limb", "zone_on_held"), ("human", "zone_on_held")):
        for run, values in (("iterations", (6, 24)), ("time_step", (5, 10)), ("resolution", (300, 600))):
            write_origin(study / f"{run}_{body}")
            rows = []
            for value, method, (seed, converged, young_pa) in itertools.product(
                    values, ("pbs", "xpbd"), ((0, 1, 3e4), (0, 0, 3e4), (3, 1, 3e4), (0, 1, 3e5))):
                n, step = value if run == "iterations" else 24, value if run == "time_step" else 10
                real = 10.0 * n * 100 / step**2 if method == "pbs" else 50.0
                rows.append({"body": body, "load": load, "vertices": value if run == "resolution" else 300, "mesh": "wanted",
                             "method": method, "k_stretch": 0.2, "young_pa": young_pa, "iterations": n, "time_step_ms": step,
                             "order_seed": seed, "by": "linear", "converged": converged,
                             "stiffness_n_m": real if (seed, converged, young_pa) == (0, 1, 3e4) else 1.0})
            write_table(study / f"{run}_{body}" / "stiffness.csv", rows)


def write_momentum(study):
    """Only rounding if masses are weighted, a quarter if they are not; all of it to the bones."""
    masses = {"equal": 1e-6, "unequal": 1e-6, "unequal_by_eq_8_9": 0.25}
    for body in ("limb", "human"):
        write_origin(study / body)
        rows = [{"claim": "C07", "quantity": f"{momentum}_drift{of_pass}" + ("_taken_by_bones" if of == "bind" else ""), "body": body,
                 "order": "plain" if of_pass else "", "precision": precision, "masses": mass, "constraint": of,
                 "value": 1.0 if of == "bind" else drift}
                for mass, drift in masses.items() for of in ("stretch", "volume", "bind") for momentum in ("linear", "angular")
                for precision in ("f32", "f64") for of_pass in ("", "_of_a_pass")]
        write_table(study / body / "measurements.csv", rows)


def write_timing(study):
    """A microsecond per vertex with plain loops, an eighth of it in order; one mesh has the size of one of the paper's."""
    write_origin(study / "man_1654")
    write_table(study / "timing.csv",
          [{"mesh": f"man_{vertices}", "body": "man", "variant": variant, "precision": precision, "vertices": vertices,
            "tets": 5 * vertices, "total_wall_ms": total, "total_wall_ms_low": total, "total_wall_ms_high": total,
            "paper_ms": 11.0 if vertices == 1654 else "", "paper_ct_ms": 0.52 if vertices == 1654 else "",
            **{f"{part}_ms": total / 5 for part in ("lbs", "bind", "stretch", "volume", "rest")}}
           for vertices in (1654, 20000) for variant, precision, scale in (("plain", "f64", 1), ("plain", "f32", 1), ("ordered", "f32", 8))
           for total in [1e-3 * vertices / scale]])


def write_features(study):
    """Sleep halves the time of a frame of the limb; the human has one more feature."""
    for scene, features in (("limb", ("sleep",)), ("human", ("sleep", "rendered surface"))):
        write_origin(study / f"features_{scene}")
        write_table(study / f"features_{scene}" / "features.csv",
              [{"feature": feature} | {f"{of}_cpu_ms_ratio{part}": factor * (0.5 if feature == "sleep" else 1.5) for of in ("frame", "step")
                                       for part, factor in (("", 1.0), ("_lower", 0.9), ("_upper", 1.1))} for feature in features])
