"""Reference: the definition. The paper's own figures show the recorded frames, name the origin of body and motion, and are refused without
records; every figure names its runs."""
import json
import unittest

import numpy

from results_case import ResultsTest
import records
import synthetic_frames
import synthetic_records
import synthetic_tables
from drawing import bodies
from figures import timing
from records import entries, recorded_frames

listed = {entry.name: entry for entry in entries.read()}
own = [entry for entry in listed.values() if entry.name.startswith(("fig_", "table_", "clip_"))]


class OwnFigures(ResultsTest):
    def frames(self, scene="limb_bend"):
        synthetic_frames.write_frames(self.results, scene, frames=10)
        (self.results / "frames" / scene / "binding.csv").write_text(
            "vertex,bone,parameter,rest_distance_m,blended,jiggles\n1,forearm,0.5,0.2,0,0\n0,upper,0.25,0.1,0,0\n2,forearm,1.5,0.3,1,1\n")
        return recorded_frames.Frames(self.results, scene)

    def test_every_own_figure_is_listed_and_refuses_without_records(self):
        names = [entry.name[:6] for entry in own if entry.name.startswith("fig_")]
        self.assertEqual(names, [f"fig_{number:02}" for number in range(1, 11)])
        for entry in own:
            with self.subTest(entry.name):
                with self.refused("does not exist"):
                    entry.draw(self.results)

    def test_projections_lie_on_the_posed_bone_within_its_ends(self):
        frames = self.frames()
        found = frames.projections(frames.bones(3))  # bones upper from x = 0 to 1 and forearm from 1 to 2, at z = 3
        self.assertEqual(found.tolist(), [[0.25, 0, 3], [1.5, 0, 3], [2, 0, 3]])
        self.assertEqual(frames.projections(frames.bones_at_rest()).tolist(), [[0.25, 0, 0], [1.5, 0, 0], [2, 0, 0]])

    def test_rows_and_files_are_found_by_label_and_frame(self):
        frames = self.frames()
        self.assertEqual(frames.frame_at_angle(70), 7)
        self.assertEqual(frames.row("pbs", 7)["min_section_pct"], "93")
        self.assertEqual(frames.skin("lbs", 2), frames.tets("lbs", 2))  # without a rendered surface, the boundary of the tets
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
        # Coordinates of at most 3 m are written with all digits. They go through ten roundings, and so does the number expected.
        rounding_mm = 1000 * numpy.sqrt(3) * 2 * 10 * numpy.finfo(float).eps / 2 * 3
        numpy.testing.assert_allclose(away_mm, 1000 * 0.1 * (1.1 - 1.05) * 3 * numpy.linalg.norm(at_rest, axis=1), rtol=0, atol=rounding_mm)
        tets = frames.tets("pbs", 3)
        self.assertEqual(bodies.bone_under(frames, 2, tets), "bone 0")  # only the first corner of the first tet carries it
        self.assertEqual(bodies.bone_under(frames, 1, tets), "bone 2")  # -1/2 of vertex 1, and equal halves of 2, 3 and 4

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
        synthetic_tables.write_origin(self.results / "timing")
        synthetic_tables.write_table(self.results / "timing" / "timing.csv", [
            {"mesh": mesh, "body": mesh[:-2], "model": model, "stands_in": stands_in, "vertices": 200, "edges": 600, "tets": 400,
             "vertices_over_table_1": 0.5, "edges_over_table_1": 0.75, "tets_over_table_1": 0.8, "variant": order, "precision": precision,
             "total_ms": 4.0 if order == "plain" else 0.5, "frames_per_s": 250, "paper_frames_per_s": 90.5, "paper_ms": 11.05,
             "paper_ct_ms": 0.52, "cpu_model": "a processor"}
            for mesh, model, stands_in in (("human_1", "Man", 1), ("man_1", "Man", 0), ("human_9", "-", 0)) for order, precision in orders])

    def test_table_1_shows_the_papers_own_body_and_the_counts_it_prints(self):
        self.write_timing()
        self.make_all("table_1_timing")
        row, = self.rows("table_1_timing")
        self.assertEqual((row["mesh"], row["vertices"], row["edges"], row["tets"]), ("man", "400 / 200", "800 / 600", "500 / 400"))
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
        synthetic_tables.write_origin(self.results / "volume" / "a_first", of="f" * 40)  # before them in alphabetical order
        scenes = {}
        for name in ("limb_twist", "limb_bend"):
            run = self.results / "volume" / name / "run.json"
            record = json.loads(run.read_text())
            record["scene"]["name"] = name
            record["provenance"]["cpu_model"] = "a processor"
            run.write_text(json.dumps(record))
            scenes[name] = records.scene_hash(record)
        self.assertEqual(listed["volume_over_angle"].origin(self.results), {
            "version": "0.1.0", "git_revision": synthetic_records.revision, "git_dirty": False, "cpu_model": "a processor",
            "scenes": scenes, "rights": ""})
        self.make_all("volume_over_angle")
        shown = (self.results / "figures" / "volume_over_angle.png").read_bytes()
        for text in (synthetic_records.revision, "; a processor; ", *(f"scene {name} {digest}" for name, digest in scenes.items())):
            self.assertIn(text.encode(), shown)

    def test_all_revisions_and_processors_are_named(self):
        runs = {name: {"work": {"name": name}, "provenance": {"git_revision": name * 4, "cpu_model": cpu, "git_dirty": name == "b"}}
                for name, cpu in (("a", "one"), ("b", "two"), ("c", "one"))}
        origin = records.origin_of(runs)
        self.assertEqual((origin["git_revision"], origin["cpu_model"]), ("aaaa and bbbb and cccc", "one and two"))
        self.assertTrue(origin["git_dirty"])
        self.assertEqual(len(set(origin["scenes"].values())), 3)
        self.assertEqual(records.origin_of({"kept": {}}), {"git_dirty": False, "scenes": {}})


if __name__ == "__main__":
    unittest.main()
