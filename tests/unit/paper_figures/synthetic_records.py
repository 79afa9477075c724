"""Records in the layout of a run's directory, with made-up numbers that a test can foresee."""
import csv
import json

columns = ["scene", "deformer", "variant", "iterations", "frame", "time_s", "volume_change_pct", "volume_abs_change_pct", "inverted_tets",
           "min_section_pct", "angle_deg"]
revision = "0123456789abcdef0123456789abcdef01234567"


def write_run(folder, frames=37, last_angle_deg=180.0):
    """last_angle_deg None: a clip. LBS changes the volume by -angle / 10 %, PBS by a hundredth over its iterations."""
    folder.mkdir(parents=True)
    (folder / "run.json").write_text(json.dumps(
        {"scene": {"reference": {"name": "fem_p2"}}, "provenance": {"version": "0.1.0", "git_revision": revision, "git_dirty": False}}))
    with open(folder / "metrics.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, columns)
        writer.writeheader()
        for frame in range(frames):
            angle = (last_angle_deg or 90.0) * frame / (frames - 1)
            specs = [("lbs", "", "default", -angle / 10), ("dqs", "", "default", angle / 20), ("fem_p2", "", "default", angle / 5)]
            specs += [("pbs", count, "default", -angle / 1000 / count) for count in (1, 24, 96)] + [("pbs", 24, "jiggle", -angle / 500)]
            for deformer, iterations, variant, change in specs:
                writer.writerow({"scene": folder.name, "deformer": deformer, "variant": variant, "iterations": iterations, "frame": frame,
                                 "time_s": frame / 100, "volume_change_pct": change, "volume_abs_change_pct": abs(change), "inverted_tets": 0,
                                 "min_section_pct": 100 + change, "angle_deg": angle if last_angle_deg else ""})


def write_study(results):
    write_run(results / "volume" / "limb_twist")
    write_run(results / "volume" / "limb_bend", frames=31, last_angle_deg=150.0)
    write_run(results / "volume" / "human_01_01", frames=50, last_angle_deg=None)
    write_run(results / "volume" / "human_01_01_truth", frames=50, last_angle_deg=None)
    write_regions(results)
    (results / "claims.md").write_text("# Claims\n\n| id | measured |\n|---|---|\n| C01 | 9 \\| 17 %, *signed* |\n\nmore text\n")


def write_regions(results):
    """One bone and one joint of the human; LBS changes them by -1 %, the others by less."""
    with open(results / "volume" / "regions.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["run", "deformer", "kind", "region", "rest_share_pct", "change_pct", "own_change_pct"])
        writer.writeheader()
        for deformer, change in (("lbs", -1.0), ("dqs", -0.75), ("pbs", -0.125), ("snh_p1", -0.25)):
            for kind, region in (("bone", "spine"), ("joint", "spine - chest")):
                writer.writerow({"run": "human_01_01_truth", "deformer": deformer, "kind": kind, "region": region, "rest_share_pct": 10.0,
                                 "change_pct": change, "own_change_pct": 10 * change})


verification_columns = ["problem", "quantity", "elements", "material", "mesh", "h_m", "dofs", "value", "reference", "unit", "difference_pct"]


def write_verification(results):
    """Errors h^(p + 1) and h^p of P1 and P2, and one benchmark, coarse and fine, of each."""
    folder = results / "verification"
    (folder / "beam").mkdir(parents=True)
    (folder / "beam" / "run.json").write_text(json.dumps({"provenance": {"version": "0.1.0", "git_revision": revision, "git_dirty": False}}))
    with open(folder / "verification.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, verification_columns)
        writer.writeheader()
        for order in (1, 2):
            for h in (0.5, 0.25, 0.125):
                for norm, gain in (("error in L2 over that of the solution", 1), ("error in the H1 seminorm over that of the solution", 0)):
                    writer.writerow({"problem": "manufactured_solution", "quantity": norm, "elements": f"P{order}", "h_m": h, "dofs": 1 / h,
                                     "value": h ** (order + gain), "material": "linear, nu = 0.3", "difference_pct": ""})
            for dofs, difference in ((10, -30.0), (20, -10.0 / order ** 4)):
                writer.writerow({"problem": "cantilever", "quantity": "tip deflection", "elements": f"P{order}", "h_m": 1, "dofs": dofs,
                                 "value": 1, "reference": 1, "material": "linear, nu = 0.3", "difference_pct": difference})
    (folder / "verification.md").write_text("| problem | holds |\n|---|---|\n| cantilever | yes |\n\n1. closed form: a beam\n")


def write_fit(results):
    """E = 100 kPa k_stretch * iterations; the misfit is 20 % + |nu - 0.3|."""
    folder = results / "fit"
    (folder / "sag_300").mkdir(parents=True)
    (folder / "sag_300" / "run.json").write_text(json.dumps({"provenance": {"version": "0.1.0", "git_revision": revision, "git_dirty": False}}))
    with open(folder / "sag.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["vertices", "k_stretch", "k_volume", "iterations", "young_pa", "settled"])
        writer.writeheader()
        for k_stretch in (0.05, 0.2, 0.9):
            for iterations in (24, 96):
                for k_volume, settled in ((0.0, 1), (1.0, 1)):
                    writer.writerow({"vertices": 300, "k_stretch": k_stretch, "k_volume": k_volume, "iterations": iterations,
                                     "young_pa": 1e5 * k_stretch * iterations, "settled": settled})
    with open(folder / "valley.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["model", "element_order", "attachment", "body", "k_stretch", "poisson", "misfit_pct"])
        writer.writeheader()
        for body in ("pbs", "pbs_converged"):
            for poisson in (0.0, 0.3, 0.49):
                writer.writerow({"model": "stable_neo_hookean", "element_order": 2, "attachment": "embedded", "body": body,
                                 "k_stretch": 0.2, "poisson": poisson, "misfit_pct": 20 + abs(poisson - 0.3)})


def write_work_precision(results):
    """PBS: an error of 40 % / n after n iterations of a millisecond each; the reference's own is 15 % at most, the second solution 3 % away."""
    folder = results / "work_precision"
    (folder / "limb").mkdir(parents=True)
    (folder / "limb" / "run.json").write_text(json.dumps({"provenance": {"version": "0.1.0", "git_revision": revision, "git_dirty": False}}))
    of_point = ["deformer", "setting", "ms_median", "error_joint_pct"]
    points = [("lbs", "", 0.1, 50.0), *(("pbs", f"{n} iterations", float(n), 40.0 / n) for n in (1, 2, 4))]
    with open(folder / "limb" / "points.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["body", "pose", *of_point, "outcome", "reference_error_joint_pct", "error_joint_beside_pct"])
        writer.writeheader()
        for point in points:
            writer.writerow({"body": "limb", "pose": "90 deg", **dict(zip(of_point, point)), "outcome": "finished",
                             "reference_error_joint_pct": 15.0, "error_joint_beside_pct": point[3]})
        writer.writerow({"body": "limb", "pose": "90 deg", "deformer": "snh", "setting": "P2", "ms_median": 900.0, "outcome": "reference",
                         "reference_error_joint_pct": 15.0, "error_joint_beside_pct": 3.0})
    with open(folder / "fronts.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, ["case", "measure", "front", *of_point])
        writer.writeheader()
        for point in points:
            for front in ("all", point[0]):
                writer.writerow({"case": "limb, 90 deg", "measure": "error_joint_pct", "front": front, **dict(zip(of_point, point))})


def write_bench(results):
    """A step of c microseconds a constraint, c = 24 for plain, 3 for ordered in f32, twice that in f64; two threads bring 1.5."""
    folder = results / "bench"
    (folder / "timings").mkdir(parents=True)
    (folder / "timings" / "run.json").write_text(json.dumps({"provenance": {"version": "0.1.0", "git_revision": revision, "git_dirty": False}}))
    point = {"flops_per_byte": 2.0, "gflops": 10.0, "attainable_gflops": 40.0, "share_of_limit": 0.25}

    def timing(variant, precision, threads, ms_step):
        single = {"roofline": {name: point for name in ("stretch", "volume", "bind")}} if threads == 1 else {"speedup_by_threads": 1.5}
        return {"variant": variant, "precision": precision, "threads": threads, "ms_step": ms_step, "ratio_to_plain": 1.0,
                "quartiles": {"ms_step": [0.9 * ms_step, 1.1 * ms_step]}, **single}

    def mesh(vertices, edges, tets):
        count = vertices + edges + tets
        results = [timing(variant, precision, threads, 1e-3 * c * scale * count)
                   for variant, c in (("plain", 24.0), ("ordered", 3.0)) for precision, scale in (("f32", 1.0), ("f64", 2.0))
                   for threads in (1, 2) if variant == "ordered" or threads == 1]
        return {"mesh": {"vertices": vertices, "edges": edges, "tets": tets}, "results": results, "yardsticks": []}

    copy = [{"bytes": 1e4, "gb_s": 400.0}, {"bytes": 1e8, "gb_s": 20.0}]
    (folder / "bench.json").write_text(json.dumps(
        {"context": {"threads": 2, "iterations": 24, "limits_of_one_core": {"fma_gflops_f32": 200.0, "fma_gflops_f64": 100.0, "copy": copy}},
         "meshes": [mesh(100, 500, 400), mesh(1000, 6000, 5000)],
         "scaling": [{"variant": "ordered", "precision": "f32", "threads": 1, "exponent": 1.0, "interval": [None, None]}]}))
