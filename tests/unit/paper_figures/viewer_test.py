"""Reference: the definition. The packed data represent the records within what the header states; errors name what is
missing, and no page is made from incomplete data."""
import base64
import csv
import gzip
import json
import math
import os
import re
import shutil
import types
import unittest

import numpy

from results_case import ResultsTest
import records
import synthetic_frames
from figures import stills
from viewer import data as viewer_data, page as viewer_html
from words import looks


class Viewer(ResultsTest):
    def setUp(self):
        super().setUp()
        synthetic_frames.write_frames(self.results)
        self.run = self.results / "frames" / "limb_twist"

    def pack(self, every=1):
        return viewer_data.pack(viewer_data.recorded_runs(self.results), every)

    def unpacked(self, every=1):
        header, block = self.pack(every)
        return header["runs"][0], gzip.decompress(block)

    def test_positions_are_those_recorded_within_half_a_step(self):
        run, block = self.unpacked()
        for deformer in run["deformers"]:
            count = len(run["frames"]) * run["vertices"] * 3
            low, high = numpy.frombuffer(block, "u1", 2 * count,
                                         deformer["positions"]).reshape(2, len(run["frames"]), -1).astype(int)
            codes = numpy.cumsum(low + 256 * high, axis=0) % 65536
            packed = numpy.tile(run["low_m"], run["vertices"]) + run["step_m"] * codes
            for at, frame in enumerate(run["frames"]):
                recorded = numpy.ravel(synthetic_frames.positions_of(deformer["label"], frame))
                self.assertLessEqual(abs(packed[at] - recorded).max(), run["step_m"] / 2 * (1 + 1e-9))

    def test_tets_ratios_and_bones(self):
        run, block = self.unpacked()
        corners = numpy.frombuffer(block, "<u4", 8, run["tet_corners"])
        self.assertEqual(corners.tolist(), [corner for tet in synthetic_frames.tets for corner in tet])
        lbs = next(deformer for deformer in run["deformers"] if deformer["label"] == "lbs")
        codes = numpy.frombuffer(block, "u1", 8, lbs["ratios"]).reshape(4, 2)
        self.assertEqual(codes[2].tolist(), [0, 1 + round(0.5 * 127)])
        self.assertEqual(codes[0].tolist(), [128, 1 + round(0.5 * 127)])
        ends = numpy.frombuffer(block, "<f4", 4 * 12, run["bones"]["ends"]).reshape(4, 2, 6)
        self.assertEqual(ends[3].tolist(), [[0, 0, 3, 1, 0, 3], [1, 0, 3, 2, 0, 3]])

    def test_the_rendered_surface_is_carried_within_the_rounding_of_the_tets(self):
        self.assertIsNone(self.unpacked()[0]["surface"])  # the limb has none but its tets
        shutil.rmtree(self.run)
        synthetic_frames.write_frames(self.results, "human_jump", body="human")
        run, block = self.unpacked()
        surface = run["surface"]
        self.assertEqual((surface["points"], surface["triangles"]), (3, 1))
        self.assertEqual(numpy.frombuffer(block, "<u4", 3, surface["corners"]).tolist(), [0, 1, 2])
        shares = numpy.frombuffer(block, "<f4", 12, surface["shares"]).reshape(3, 4)
        carriers = numpy.array(synthetic_frames.tets)[numpy.frombuffer(block, "<u4", 3, surface["tets"])]
        for deformer in run["deformers"]:
            low, high = numpy.frombuffer(block, "u1", 2 * 4 * 15, deformer["positions"]).reshape(2, 4, 5, 3).astype(int)
            codes = numpy.cumsum(low + 256 * high, axis=0) % 65536
            packed = numpy.einsum("pc,fpcx->fpx", shares, (run["low_m"] + run["step_m"] * codes)[:, carriers])
            for frame in range(4):
                recorded = synthetic_frames.skin_of(synthetic_frames.positions_of(deformer["label"], frame))
                apart = abs(packed[frame] - recorded).max(axis=1)
                self.assertTrue((apart <= abs(shares).sum(axis=1) * run["step_m"] / 2 * (1 + 1e-6)).all())

    def test_points_that_joints_carry_are_not_drawn(self):
        """The tets carry them elsewhere."""
        shutil.rmtree(self.run)
        synthetic_frames.write_frames(self.results, "human_jump", body="human")
        file = self.results / "frames" / "human_jump" / "embedding.csv"
        head, *lines = file.read_text().splitlines()
        for share, triangles, points in (("0.5", 1, 0), ("0.75", 0, 1)):
            file.write_text("\n".join([head + ",joint_share", lines[0] + ",0", lines[1] + "," + share, lines[2] + ",0"])
                            + "\n")
            surface = self.unpacked()[0]["surface"]
            self.assertEqual((surface["triangles"], surface["of_joints"], surface["points"]), (triangles, points, 3))

    def test_pbs_of_another_stiffness_says_which_and_which_its_zone(self):
        plain = {"k_stretch": 0.2}
        options = {"pbs": plain, "pbs_jiggle": {"k_stretch": 1.0, "jiggle": {"k_stretch": 0.1}},
                   "pbs_no_zone": {"k_stretch": 1.0}, "pbs_increment": {**plain, "lbs_entry": "increment"},
                   "nh_p1": {"poisson": 0.45}}
        runs = [{"label": label, "options": set_to} for label, set_to in options.items()] + [{"label": "lbs"}]
        recorded = types.SimpleNamespace(run=types.SimpleNamespace(record={"scene": {"runs": runs}}))
        self.assertEqual([viewer_data.title_of(recorded, label) for label in ("lbs", *options)],
                         ["LBS", "PBS", "PBS, k_stretch 1, zone 0.1", "PBS, k_stretch 1, no zone",
                          "PBS without LBS as initial guess", "neo-Hookean FEM, linear elements"])

    def test_a_surface_and_what_carries_it_belong_together(self):
        synthetic_frames.write_frames(self.results, "human_jump", body="human")
        file = self.results / "frames" / "human_jump" / "embedding.csv"
        file.write_text("".join(file.read_text().splitlines(keepends=True)[:-1]))
        with self.refused("embedding.csv: 2 points, but surface_rest.vtp has more"):
            self.pack()
        file.unlink()
        with self.refused("embedding.csv: does not exist"):
            self.pack()

    def test_numbers_are_the_records_own(self):
        run, _ = self.unpacked(every=2)
        self.assertEqual(run["frames"], [0, 2])
        lbs = next(deformer for deformer in run["deformers"] if deformer["label"] == "lbs")
        self.assertEqual(lbs["figures"]["volume_change_pct"], [-2.0, -9.0])
        self.assertEqual(lbs["figures"]["inverted_tets"], [0.0, 1.0])
        self.assertEqual([deformer["title"] for deformer in run["deformers"]],
                         ["LBS", "DQS", "PBS", "neo-Hookean FEM, linear elements"])
        self.assertEqual([deformer["colour"] for deformer in run["deformers"]],
                         [looks.of(name).color for name in ("lbs", "dqs", "pbs", "nh_p1")])

    def test_a_run_without_a_reference_or_with_errors_that_are_not_finite_is_packed(self):
        file = self.run / "metrics.csv"
        with open(file, newline="") as stream:
            rows = [row | {"error_joint_pct": "nan"} for row in csv.DictReader(stream)]
        synthetic_frames.write_table(file, rows)
        header, _ = self.pack()
        json.dumps(header, allow_nan=False)
        self.assertEqual(header["runs"][0]["deformers"][0]["figures"]["error_joint_pct"], [None] * 4)
        record = json.loads((self.run / "run.json").read_text())
        record["scene"]["reference"] = {"name": ""}
        (self.run / "run.json").write_text(json.dumps(record))
        self.assertEqual(self.pack()[0]["runs"][0]["reference"], "")

    def test_frames_whose_pose_was_not_reached_are_packed_as_such(self):
        shutil.rmtree(self.run)
        synthetic_frames.write_frames(self.results, not_reached=[("nh_p1", 2), ("nh_p1", 3), ("pbs", 0)])
        runs = [self.pack(every)[0]["runs"][0] for every in (1, 2)]
        found = [{deformer["label"]: deformer["not_reached"] for deformer in run["deformers"]} for run in runs]
        self.assertEqual(found, [{"lbs": [], "dqs": [], "pbs": [0], "nh_p1": [2, 3]},
                                 {"lbs": [], "dqs": [], "pbs": [0], "nh_p1": [1]}])

    def test_a_frame_without_a_solution_is_one_that_was_not_reached_and_shows_the_last_state(self):
        file = self.run / "metrics.csv"
        with open(file, newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if (row["deformer"], row["frame"]) != ("nh_p1", "2")]
        synthetic_frames.write_table(file, rows)
        (self.run / "frames" / "nh_p1_000002.vtu").unlink()
        run, block = self.unpacked()
        reference = next(of for of in run["deformers"] if of["label"] == "nh_p1")
        self.assertEqual((run["frames"], reference["not_reached"]), ([0, 1, 2, 3], [2]))
        self.assertIsNone(reference["figures"]["volume_change_pct"][2])
        low, high = numpy.frombuffer(block, "u1", 2 * 4 * 15, reference["positions"]).reshape(2, 4, 15)
        # Differences to the frame before.
        self.assertEqual((low[2].any(), high[2].any(), low[3].any()), (False, False, True))

    def test_stills_say_under_a_pose_that_it_was_not_reached(self):
        row = {"inverted_tets": "1", "min_section_pct": "40", "volume_change_pct": "-2"}
        for words in (stills.moment_words, stills.artefacts):
            for outcome, marked in (("finished", False), ("not_converged", True), ("not_finite", True), (None, False)):
                with self.subTest(words, outcome=outcome):
                    self.assertEqual("pose not reached" in stills.filled({**row, "outcome": outcome}, words), marked)

    def break_down(self, label):
        """A position of the deformer becomes infinite in frame 1 and is not a number in frame 2."""
        for frame, number in ((1, "inf"), (2, "nan")):
            file = self.run / "frames" / f"{label}_{frame:06}.vtu"
            first = " ".join(map(str, synthetic_frames.positions_of(label, frame)[1]))
            file.write_text(file.read_text().replace(first, f"{number} 0 0", 1))

    def test_a_deformer_that_broke_down_is_left_out_and_named_and_the_others_are_shown(self):
        os.environ["PBS_VIEWER_BUILD"] = str(self.results)
        self.addCleanup(os.environ.pop, "PBS_VIEWER_BUILD")
        (self.results / "viewer.js").write_text("")
        shown = self.unpacked()[0]["deformers"]
        self.assertEqual([deformer["label"] for deformer in shown], ["lbs", "dqs", "pbs", "nh_p1"])
        for number, (label, title) in enumerate((("pbs", "PBS"), ("nh_p1", looks.of("nh_p1").name))):
            self.break_down(label)
            run, _ = self.unpacked()
            self.assertEqual([deformer["label"] for deformer in run["deformers"]],
                             ["lbs", "dqs", *(["nh_p1"] if number == 0 else [])])
            self.assertIn({"title": title, "frame": 1}, run["left_out"])
            page = viewer_html.fragment(self.results)
            words = (f'<p class="missing">limb, twist: {title} is not shown, for a position in frame 1 is not '
                     'finite.</p>')
            self.assertIn(words, page.split("<script", 1)[0])
        for label in ("lbs", "dqs"):
            self.break_down(label)
        with self.refused("frames: every deformer has a position that is not finite"):
            self.pack()

    def test_scales_and_codes_of_difference_and_contact(self):
        rest = numpy.array([[0, 0, 0], [0, 0.85, 0]])  # half of 1.7 m
        positions = {"nh_p1": numpy.zeros((1, 2, 3)), "lbs": numpy.full((1, 2, 3), 0.03 / math.sqrt(3))}
        depths = numpy.array([0, -1, 1, 400, 10000, 1000000])
        scales = viewer_data.scales_of({"lbs": [(None,) * 4 + (depths,)]}, positions, "nh_p1", rest)
        self.assertEqual([scales[name] for name in ("mm_per_m", "difference_mm", "deepest_mm")], [2000, 100, 2000])
        self.assertEqual(viewer_data.contact_codes([(None,) * 4 + (depths,)], 2000).tolist(), [[0, 1, 2, 4, 42, 255]])
        older = viewer_data.scales_of({"lbs": [(None,) * 5]}, positions, "", rest)
        self.assertEqual((older["difference_mm"], older["deepest_mm"]), (1, 1))
        self.assertEqual([viewer_data.rounded_up(value) for value in (0, 1, 1.01, 3, 60, 0.02)],
                         [1, 1, 2, 5, 100, 0.02])

    def test_panels_of_a_claim_are_those_on_record(self):
        figures = {column: [0.0, 1.0] for column in viewer_data.figures}
        run = {"name": "human_walk", "frames": [0, 1], "deformers": [{"label": label, "figures": figures}
                                                                      for label in ("lbs", "pbs_jiggle", "nh_p1")]}
        self.assertEqual([(pose["claim"], pose["panels"]) for pose in viewer_html.poses_of([run])],
                         [("C09a", "lbs,pbs_jiggle,nh_p1")])
        run["deformers"].append({"label": "pbs_no_zone", "figures": figures})
        self.assertEqual(viewer_html.poses_of([run])[0]["panels"], "lbs,pbs_no_zone,pbs_jiggle,nh_p1")

    def test_a_claim_opens_at_the_recorded_extreme(self):
        links = viewer_html.claim_links(self.results)
        self.assertEqual(links, {"C01": "#run=limb_twist&frame=2&colour=ratio&claim=C01",
                                 "C04": "#run=limb_twist&frame=3&colour=skin&panels=lbs,dqs,pbs,nh_p1&claim=C04"})
        self.assertEqual(viewer_html.position_of([1.0, None, -3.0], "far"), 2)
        self.assertIsNone(viewer_html.position_of([None], max))

    def test_what_is_missing_is_named(self):
        for file, words in ((self.run / "frames" / "pbs_000001.vtu", "pbs_000001.vtu: does not exist"),
                            (self.run / "metrics.csv", "metrics.csv: does not exist")):
            file.unlink()
            with self.refused(words):
                self.pack()
        self.run.rename(self.results / "frames" / "another")
        with self.refused("no frames on record"):
            self.pack()

    def test_a_run_that_tells_no_scene_or_another_kind_of_one_is_refused_by_field(self):
        for scene, words in (({}, "scene.character: missing"), ([], "scene = []: expected an object"),
                             ({"character": {"body": "limb"}, "motion": {}, "runs": ["pbs"]},
                              'scene.runs[0] = "pbs": expected an object')):
            (self.run / "run.json").write_text(json.dumps({"scene": scene}))
            with self.subTest(words), self.assertRaises(records.RecordsMissing) as caught:
                viewer_html.claim_links(self.results)
            self.assertEqual(str(caught.exception), f"{self.run / 'run.json'}: {words}")

    def test_frames_left_from_an_earlier_plan_or_changed_since_are_refused(self):
        (self.results / "frames" / "plan.json").write_text(json.dumps({"runs": [{"name": "limb_twist"}]}))
        viewer_data.recorded_runs(self.results)
        written_s = (self.run / "run.json").stat().st_mtime
        os.utime(self.run / "frames" / "pbs_000001.vtu", (written_s + 600, written_s + 600))
        with self.refused("pbs_000001.vtu was changed after its run ended"):
            viewer_html.claim_links(self.results)
        (self.results / "frames" / "plan.json").write_text(json.dumps({"runs": [{"name": "limb_bend"}]}))
        with self.refused("no run of its study"):
            self.pack()

    def test_page_with_and_without_the_program(self):
        os.environ["PBS_VIEWER_BUILD"] = str(self.results)
        self.addCleanup(os.environ.pop, "PBS_VIEWER_BUILD")
        with self.refused("npm ci"):
            viewer_html.fragment(self.results)
        (self.results / "viewer.js").write_text('run("</script>")')
        page = viewer_html.fragment(self.results)
        header = json.loads(re.search(r'id="viewer-header">(.*?)</script>', page)[1])
        self.assertEqual(header["runs"][0]["name"], "limb_twist")
        block = re.search(r'id="viewer-block">(.*?)</script>', page)[1]
        self.assertEqual(gzip.decompress(base64.b64decode(block)), self.unpacked()[1])
        self.assertEqual(page.count("</script>"), 3)
        self.assertIn('<script type="module">run(', page)  # starts when the whole page is there


if __name__ == "__main__":
    unittest.main()
