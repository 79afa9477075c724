"""Reference: the definition. Records are read by name, errors name what is missing, and figures show the records'
values and their origin. The paper's own figures show the recorded frames, name the origin of body and motion, and are
refused without records."""
import json
import unittest

import numpy

from results_case import ResultsTest
import make_all
import records
import synthetic_frames
import synthetic_records
from drawing import bodies
from figures import timing, work_precision
from records import entries, kept, recorded_frames


class Figures(ResultsTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)
        self.twist = self.results / "volume" / "limb_twist"

    def test_select_tells_iterations_and_variants_apart(self):
        run = records.Run(self.twist)
        self.assertEqual(records.numbers(run.select("pbs", 24), "volume_change_pct")[-1], -180 / 1000 / 24)
        self.assertEqual(len(run.select("pbs", 24, "jiggle")), 37)
        self.assertEqual(run.pbs_iterations(), [1, 24, 96])
        self.assertEqual(run.reference(), "fem_p2")
        run.record = {}  # as in kept records
        run.rows = [{"deformer": deformer, "error_joint_pct": error} for deformer, error in
                    (("lbs", "0"), ("nh_p1", "0"), ("nh_p2", "0"), ("lbs", "9"), ("nh_p1", "1"), ("nh_p2", "0"))]
        self.assertEqual(run.reference(), "nh_p2")

    def test_at_angle(self):
        rows = records.Run(self.twist).select("lbs")
        self.assertEqual(records.numbers([records.at_angle(rows, 90)], "volume_change_pct"), [-9.0])
        with self.refused("no frame at 91 degrees"):
            records.at_angle(rows, 91)

    def test_missing_records_are_named(self):
        run, human = records.Run(self.twist), self.results / "volume" / "human_01_01"
        clip = records.Run(human)
        (self.results / "volume" / "limb_bend" / "run.json").write_text("{")
        (human / "frame_statistics.csv").rename(human / "kept.csv")
        for words, action in (
                ("no rows of deformer pbs, variant default, 7 iterations", lambda: run.select("pbs", 7)),
                ("no column colour", lambda: records.numbers(run.select("lbs"), "colour")),
                ("column angle_deg is empty", lambda: records.numbers(clip.select("lbs"), "angle_deg")),
                ("run.json:1: not JSON", lambda: records.Run(self.results / "volume" / "limb_bend")),
                ("run.json: does not exist", lambda: records.Run(self.results / "volume")),
                ("of an earlier version and has to be made again", lambda: clip.statistics("pbs", 24))):
            with self.subTest(words), self.refused(words):
                action()

    def test_curves_are_drawn_with_their_source_and_numbers(self):
        old = self.results / "figures" / "old.png"
        old.parent.mkdir()
        old.touch()
        said, complaints = self.make_all()
        self.assertEqual(complaints, "")
        self.assertIn("verification left out: the study verification was not run", said)
        self.assertFalse(old.exists())
        for name in ("volume_over_angle", "volume_over_clip", "volume_over_iterations"):
            for ending in ("png", "pdf", "svg"):
                self.assertIn(synthetic_records.revision.encode(),
                              (self.results / "figures" / f"{name}.{ending}").read_bytes())
        rows = [row for row in self.rows("volume_over_angle") if row["deformer"] == "lbs"
                and row["scene"] == "limb_twist"]
        self.assertEqual([float(row["volume_change_pct"]) for row in rows], [-angle / 10 for angle in range(0, 181, 5)])
        signed = [row for row in self.rows("volume_over_iterations")
                  if row["pose"] == "all frames" and row["measure"] == "volume_change_pct"]
        self.assertEqual([(row["iterations"], row["q10"], row["median"], row["q90"]) for row in signed],
                         # The quantiles are from the record, not computed from the rows.
                         [(count, "-3.0", "-2.0", "-1.0") for count in ("1", "24", "96")])
        with self.assertRaises(SystemExit):
            make_all.main(self.results / "figures")

    def test_order_statistics_are_of_one_setting(self):
        human = records.Run(self.results / "volume" / "human_01_01")
        with self.refused("3 rows of deformer pbs, variant default, expected one"):
            human.statistics("pbs")
        with self.refused("0 rows of deformer pbs, variant jiggle, 24 iterations, expected one"):
            human.statistics("pbs", 24, "jiggle")


class OtherStudies(ResultsTest):
    def test_figures_of_records_that_are_gone_are_deleted(self):
        figures = self.results / "figures"
        figures.mkdir()
        for name in ("error_against_time.svg", "error_against_time.csv", "somebody's.svg"):
            (figures / name).write_text("")
        with self.assertRaisesRegex(SystemExit, "no study in it"):
            make_all.main(self.results)
        self.assertEqual([path.name for path in figures.iterdir()], ["somebody's.svg"])

    def test_the_record_that_judges_a_part_is_named_by_it(self):
        record = self.results / "record"
        plan, repeated = self.results / "volume" / "plan.json", self.results / "repeated.json"
        for extent, first, is_behind in (("quick", str(record), True), ("full", str(record), False),
                                         ("quick", str(self.results), False), ("quick", 3, False)):
            for file, content in ((record / "provenance.json", {"origins": []}), (plan, {"extent": extent}),
                                  (repeated, {"first": first})):
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(json.dumps(content))
            with self.subTest(f"{extent} {first}"):
                self.assertEqual(kept.record_behind(self.results), record if is_behind else None)

    def test_verification_shows_the_finest_mesh_of_each_benchmark(self):
        synthetic_records.write_verification(self.results)
        rows = [row for row in self.drawn("verification") if row["problem"] == "cantilever"]
        self.assertEqual([(row["element_order"], float(row["difference_pct"])) for row in rows],
                         [("1", -10.0), ("2", -0.625)])
        self.refused_without("verification/verification.csv")

    def test_each_method_has_one_curve_with_a_point_for_each_setting_of_known_flesh(self):
        synthetic_records.write_work_precision(self.results)
        rows = self.drawn("error_against_time")
        curves = {}
        for row in (row for row in rows if row["shown"] == "curve"):
            curves.setdefault(row["method"], []).append((float(row["ms"]), round(float(row["share_pct"]), 6)))
        self.assertEqual(set(curves), set(synthetic_records.compared))
        self.assertEqual(curves["vbd"], [(0.35, 62.0), (0.7, 34.0), (1.4, 27.0), (3.5, 22.0), (7.0, 20.0)])
        self.assertEqual({row["takes"] for row in rows if row["method"] == "xpbd"}, {"material"})
        drawn = (self.results / "figures" / "error_against_time.svg").read_text()
        for text in (">vertex block descent<", ">LBS<", ">dashed: the method is given the flesh<"):
            self.assertEqual(drawn.count(text), 1, text)
        caption = (self.results / "figures" / "error_against_time.caption.txt").read_text()
        self.assertTrue(caption.startswith("Within 0.1 ms per frame, DQS leaves 86 % of LBS's error"), caption)
        self.assertIn("over 40 poses", caption)
        self.refused_without("work_precision/pairs.csv", "error_against_time")

    def test_settings_that_several_times_share_are_one_point(self):
        rows = [{"method": "lbs", "setting": "", "ms": ms, "share": "1", "share_low": "1", "share_high": "1"}
                for ms in ("0.02", "0.02", "nan")]
        self.assertEqual([row["ms"] for row in work_precision.curve_rows(rows, {"lbs": ""})], ["0.02"])

    def test_poses_solved_within_a_time_and_the_methods_that_solve_none(self):
        synthetic_records.write_work_precision(self.results)
        rows = self.drawn("solved_within_time")
        solved = {(float(row["target_pct"]), row["method"], float(row["budget_ms"])): float(row["solved_pct"])
                  for row in rows}
        self.assertAlmostEqual(solved[20.0, "vbd", 10.0], 50.0)
        self.assertEqual(solved[20.0, "pbs", 10.0], 0.0)
        drawn = (self.results / "figures" / "solved_within_time.svg").read_text()
        self.assertEqual((drawn.count(">vertex block descent<"), drawn.count(">none: LBS, DQS, delta<")), (3, 2))
        caption = (self.results / "figures" / "solved_within_time.caption.txt").read_text()
        title = (self.results / "figures" / "solved_within_time.title.txt").read_text()
        self.assertIn("Most poses are solved to 35 % of LBS's error by quasi-Newton within 1 ms (54 %)", title)
        self.assertIn("at most 20, 35 and 50 % of that of LBS", caption)

    def test_deformers_of_the_users_own_have_a_curve_and_their_clocks_are_named(self):
        synthetic_records.write_work_precision(self.results)
        synthetic_records.add_own_deformers(self.results / "work_precision",
                                            {"mine": "own", "other_one": "wall", "linked": "processor"})
        self.assertIn(("curve", "mine", "8.0"),
                      [(row["shown"], row["method"], row["ms"]) for row in self.drawn("error_against_time")])
        self.assertIn(">mine<", (self.results / "figures" / "error_against_time.svg").read_text())
        self.assertIn(" mine: time as the program states it. other_one: wall time of the program over its poses. Timed",
                      (self.results / "figures" / "error_against_time.caption.txt").read_text())

    def test_the_bench_shows_cost_a_constraint(self):
        synthetic_records.write_bench(self.results)
        rows = self.drawn("scaling")
        cost = {(row["order"], row["precision"], row["tets"]): row for row in rows
                if row["shown"] == "ns_per_constraint"}
        self.assertEqual(len(cost), 8)
        plain = cost["plain", "f32", "400"]  # 24 us per constraint and step of 24 iterations
        for column, expected in (("value", 1000.0), ("low", 900.0), ("high", 1100.0)):
            self.assertAlmostEqual(float(plain[column]), expected)
        self.assertAlmostEqual(float(cost["ordered", "f64", "5000"]["value"]), 250.0)
        self.assertEqual({row["value"] for row in rows if row["shown"] == "speedup_by_threads"}, {"1.5"})
        fits = [(row["order"], row["precision"], row["value"], row["low"]) for row in rows
                if row["shown"] == "exponent"]
        self.assertEqual(fits, [("ordered", "f32", "1.0", "")])
        bench = self.results / "timing" / "bench" / "bench.json"
        bench.write_text(json.dumps(json.loads(bench.read_text()) | {"schema": 1}))
        with self.refused("schema 1, expected 2"):
            timing.read_bench(bench)
        self.refused_without("timing/bench/bench.json", "scaling")


listed = {entry.name: entry for entry in entries.read()}


class OwnFigures(ResultsTest):
    def frames(self, scene="limb_bend"):
        synthetic_frames.write_frames(self.results, scene, frames=10)
        (self.results / "frames" / scene / "binding.csv").write_text(
            "vertex,bone,parameter,rest_distance_m,blended,jiggles\n1,forearm,0.5,0.2,0,0\n0,upper,0.25,0.1,0,0\n"
            "2,forearm,1.5,0.3,1,1\n")
        return recorded_frames.Frames(self.results, scene)

    def test_projections_lie_on_the_posed_bone_within_its_ends(self):
        frames = self.frames()
        found = frames.projections(frames.bones(3))  # bones upper from x = 0 to 1 and forearm from 1 to 2, at z = 3
        self.assertEqual(found.tolist(), [[0.25, 0, 3], [1.5, 0, 3], [2, 0, 3]])
        self.assertEqual(frames.projections(frames.bones_at_rest()).tolist(), [[0.25, 0, 0], [1.5, 0, 0], [2, 0, 0]])

    def test_rows_and_files_are_found_by_label_and_frame(self):
        frames = self.frames()
        self.assertEqual(frames.frame_at_angle(70), 7)
        self.assertEqual(frames.row("pbs", 7)["min_section_pct"], "93")
        # Without a rendered surface, the boundary of the tets.
        self.assertEqual(frames.skin("lbs", 2), frames.tets("lbs", 2))
        for words, action in (("lbs_000099.vtu: does not exist", lambda: frames.tets("lbs", 99)),
                              ("no deformer labelled pbs_jiggle", lambda: frames.row("pbs_jiggle", 1)),
                              ("bones.csv: no frame 99", lambda: frames.bones(99))):
            with self.subTest(words), self.refused(words):
                action()

    def test_a_real_body_has_a_rendered_surface(self):
        frames = self.frames()
        self.assertIsNone(frames.skin_at_rest())
        frames.body = "human"
        with self.refused("lbs_surface_000002.vtp: does not exist"):
            frames.skin("lbs", 2)
        with self.refused("surface_rest.vtp: does not exist"):
            frames.skin_at_rest()

    def test_distances_and_bones_of_points_of_the_skin(self):
        synthetic_frames.write_frames(self.results, "human_walk", body="human")
        folder = self.results / "frames" / "human_walk"
        (folder / "binding.csv").write_text("vertex,bone,parameter,rest_distance_m,blended,jiggles\n"
                                            + "".join(f"{vertex},bone {vertex},0.5,0.2,0,0\n" for vertex in range(5)))
        frames = recorded_frames.Frames(self.results, "human_walk")
        for label in ("lbs", "pbs"):
            points = synthetic_frames.skin_of(synthetic_frames.positions_of(label, 3))
            text = synthetic_frames.skin.format(positions=synthetic_frames.text(points))
            (folder / "frames" / f"{label}_surface_000003.vtp").write_text(text)
        away_mm = bodies.distances_mm(frames, 3, "lbs", "pbs")
        at_rest = numpy.array(synthetic_frames.skin_of(synthetic_frames.rest))
        # Coordinates of at most 3 m are written with all digits. They go through ten roundings, and so does the number
        # expected.
        rounding_mm = 1000 * numpy.sqrt(3) * 2 * 10 * numpy.finfo(float).eps / 2 * 3
        numpy.testing.assert_allclose(away_mm, 1000 * 0.1 * (1.1 - 1.05) * 3 * numpy.linalg.norm(at_rest, axis=1),
                                      rtol=0, atol=rounding_mm)
        tets = frames.tets("pbs", 3)
        # Only the first corner of the first tet carries it.
        self.assertEqual(bodies.bone_under(frames, 2, tets), "bone 0")
        # -1/2 of vertex 1, and equal halves of 2, 3 and 4.
        self.assertEqual(bodies.bone_under(frames, 1, tets), "bone 2")

    def test_heading_is_forward_along_the_floor(self):
        tails = {"hip.L": [0, 1, -1.0], "hip.R": [0, 0.5, 1.0]}
        bones = [recorded_frames.Bone(name, None, numpy.array(tail)) for name, tail in tails.items()]
        forward, left = recorded_frames.heading_of(bones)
        numpy.testing.assert_allclose(left, [0, 0, -1])
        numpy.testing.assert_allclose(forward, [1, 0, 0])  # left cross up

    def test_licences_are_those_of_what_is_shown(self):
        file = self.results / "frames" / "limb_bend" / "run.json"
        self.assertEqual(entries.licences_of(self.frames().run.record), [])
        record = json.loads(file.read_text())
        record["scene"] |= {"character": {"body": "human"}, "motion": {"clip": "01_03.bvh"}}
        record["provenance"] = {"git_revision": "abc"}
        file.write_text(json.dumps(record))
        origin = listed["fig_06_constraints"].origin(self.results)
        self.assertIn("MakeHuman, CC0", origin["rights"])
        self.assertIn("motion 01_03: CMU", origin["rights"])
        self.assertEqual((origin["git_revision"], origin["scenes"]), ("abc", {"limb_bend": records.scene_hash(record)}))
        self.assertNotEqual(records.scene_hash(record), records.scene_hash(record | {"scene": {}}))

    def test_a_tets_lengths_and_volume(self):
        self.frames()
        rows = {row["state"]: row for row in listed["fig_06_constraints"].draw(self.results)[1]}
        growth = 1 + 0.1 * synthetic_frames.labels["pbs"] * 9
        self.assertEqual(rows["rest"]["tet"], 1)  # points 2 to 5: the tet that is compressed most in the records
        self.assertAlmostEqual(float(rows["rest"]["volume_cm3"]), 1e6 / 3)
        self.assertAlmostEqual(float(rows["pbs"]["volume_cm3"]), growth ** 3 * 1e6 / 3, places=3)
        self.assertAlmostEqual(float(rows["rest"]["length_12_mm"]), 1000 * 2 ** 0.5)
        self.assertAlmostEqual(float(rows["pbs"]["length_34_mm"]), 1000 * growth * 2 ** 0.5, places=6)

    def write_timing(self, orders=timing.orders):
        synthetic_records.write_origin(self.results / "timing")
        synthetic_records.write_table(self.results / "timing" / "timing.csv", [
            {"mesh": mesh, "body": mesh[:-2], "model": model, "stands_in": stands_in, "vertices": 200, "edges": 600,
             "tets": 400, "vertices_over_table_1": 0.5, "edges_over_table_1": 0.75, "tets_over_table_1": 0.8,
             "variant": order, "precision": precision, "total_ms": 4.0 if order == "plain" else 0.5,
             "frames_per_s": 250, "paper_frames_per_s": 90.5, "paper_ms": 11.05, "paper_ct_ms": 0.52,
             "cpu_model": "a processor"}
            for mesh, model, stands_in in (("human_1", "Man", 1), ("man_1", "Man", 0), ("human_9", "-", 0))
            for order, precision in orders])

    def test_table_1_shows_the_papers_own_body_and_the_counts_it_prints(self):
        self.write_timing()
        self.make_all("table_1_timing")
        row, = self.rows("table_1_timing")
        self.assertEqual((row["mesh"], row["vertices"], row["edges"], row["tets"]),
                         ("man", "400 / 200", "800 / 600", "500 / 400"))
        self.assertEqual((row["paper_ms"], row["paper_ct_ms"], row["plain_f64_ms"], row["ordered_f32_ms"]),
                         ("11.1", "0.52", "4.00", "0.50"))
        text = (self.results / "figures" / "table_1_timing.tex").read_text()
        self.assertIn("Man & man & 400 / 200 & 800 / 600 & 500 / 400 & 90.5 ", text)
        self.assertIn("a processor", text)

    def test_table_1_refuses_half_a_timing(self):
        self.write_timing(orders=timing.orders[:1])
        with self.refused("not timed in plain f64 and ordered f32"):
            timing.table_1_timing(self.results)


class Origin(ResultsTest):
    def test_it_is_of_the_runs_behind_the_figure_and_no_others(self):
        synthetic_records.write_study(self.results)
        # This run is before them in alphabetical order.
        synthetic_records.write_origin(self.results / "volume" / "a_first", of="f" * 40)
        scenes = {}
        for name in ("limb_twist", "limb_bend"):
            run = self.results / "volume" / name / "run.json"
            record = json.loads(run.read_text())
            record["scene"]["name"] = name
            record["provenance"]["cpu_model"] = "a processor"
            run.write_text(json.dumps(record))
            scenes[name] = records.scene_hash(record)
        self.assertEqual(listed["volume_over_angle"].origin(self.results), {
            "version": "0.1.0", "git_revision": synthetic_records.revision, "git_dirty": False,
            "cpu_model": "a processor", "scenes": scenes, "rights": ""})
        self.make_all("volume_over_angle")
        shown = (self.results / "figures" / "volume_over_angle.png").read_bytes()
        for text in (synthetic_records.revision, "; a processor; ",
                     *(f"scene {name} {digest}" for name, digest in scenes.items())):
            self.assertIn(text.encode(), shown)

    def test_all_revisions_and_processors_are_named(self):
        runs = {name: {"work": {"name": name}, "provenance": {"git_revision": name * 4, "cpu_model": cpu,
                                                              "git_dirty": name == "b"}}
                for name, cpu in (("a", "one"), ("b", "two"), ("c", "one"))}
        origin = records.origin_of(runs)
        self.assertEqual((origin["git_revision"], origin["cpu_model"]), ("aaaa and bbbb and cccc", "one and two"))
        self.assertTrue(origin["git_dirty"])
        self.assertEqual(len(set(origin["scenes"].values())), 3)
        self.assertEqual(records.origin_of({"kept": {}}), {"git_dirty": False, "scenes": {}})


if __name__ == "__main__":
    unittest.main()
