"""Rigs from outside: each error that once passed without a message has a test here, and each warning is provoked. The rigs are those of
rig_files.py."""
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import numpy

import foreign_arm
import program
import rig_files
import skin_formula
from written_frames import points_of

MODULES = glob.glob(os.path.join(os.path.dirname(program.PBSKIN), "..", "lib", "**", "libpbskin_*.so"), recursive=True)
HAS_FEM = any(file.endswith("_fem.so") for file in MODULES)


def clip(names):
    """A BVH chain of these joints, all of which turn."""
    frames = [["0 0 0", *([f"{20 * frame} 0 0"] * len(names))] for frame in range(4)]
    return foreign_arm.bvh(names, frames, 0.1, 0.3)


class TrialTest(program.ProgramTest):
    def rig(self, variant="plain", **options):
        """One name for all, so that the cache has one mesh for those with the same surface."""
        return rig_files.write(variant, self.path("rig.glb"), **options)

    def tried(self, model, *arguments, into="out", without=("--no-reference",), vertices="300", **environment):
        """try.json and what was printed. The page has a viewer, whose program does nothing."""
        self.write("viewer.js", "// a viewer")
        process = self.succeeds("try", model, "-o", self.path(into), "--frames", "3", "--vertices", vertices, *without, *arguments,
                                env={**os.environ, "PBS_VIEWER_BUILD": self.folder, **environment})
        return self.json(into, "try.json"), process.stderr

    def refused(self, *arguments):
        return self.ends(2, *arguments).stderr

    def warned(self, facts, printed, words):
        """In the terminal, in run.json, in try.json and in the page."""
        self.assertIn(words, printed)
        self.assertTrue(any(words in warning for warning in facts["warnings"]), facts["warnings"])
        recorded = self.json("out", "run.json")["outcome"]
        self.assertEqual(sum(words in warning for warning in recorded["warnings"]), 1, recorded)
        self.assertFalse(any(words in note for note in recorded["notes"]), recorded)
        self.assertIn(words, self.read("out", "report.html"))

    def shown(self, folder="out"):
        """The run in the viewer of a page."""
        header = re.search(r'id="viewer-header">(.*?)</script>', self.read(folder, "report.html"))[1]
        return json.loads(header)["runs"][0]


class PlainRig(TrialTest):
    """Tests that read one trial of the plain rig."""
    shared = facts = None

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)

    def setUp(self):
        self.folder = self.shared.name
        if not self.facts:
            type(self).facts, _ = self.tried(self.rig(), "--paraview")

    def test_a_leaf_joint_is_a_bone_and_keeps_its_weight(self):
        self.assertIn("tip", self.facts["model"]["joints"])
        self.assertGreater(self.facts["model"]["weights_transferred_pct"], 95.0)  # 78.5 if the weights of the tip are lost

    def test_the_artists_weights_are_the_default(self):
        for name, weights in (("default", ""), ("artist", 'weights = "artist"\n'), ("paper", 'weights = "paper"\n')):
            scene = self.read("out", "scene.toml") + f"[skinning]\n{weights}"
            self.succeeds("run", self.write(os.path.join("out", f"{name}.toml"), scene), "-o", self.path(name))
        default, artist, paper = (self.json(name, "run.json")["state_hash"] for name in ("default", "artist", "paper"))
        self.assertEqual(default, artist)
        self.assertEqual(paper["lbs"], default["lbs_paper"])
        self.assertNotEqual(default["lbs"], default["lbs_paper"])

    def test_the_scale_of_nodes_is_that_of_the_skeleton_too(self):
        os.mkdir(self.path("large"))
        large, _ = self.tried(rig_files.write("doubled_container", self.path("large", "rig.glb")), into="large")
        self.assertAlmostEqual(large["model"]["extent_m"], 2.0 * self.facts["model"]["extent_m"], places=5)
        self.assertEqual(large["volume"]["lbs"]["most_inverted_tets"], 0)

    def test_the_scene_that_try_writes_can_be_run(self):
        self.succeeds("run", self.path("out", "scene.toml"), "-o", self.path("again"))
        first, again = (self.json(folder, "run.json")["state_hash"] for folder in ("out", "again"))
        self.assertEqual(first, again)

    def test_a_scene_that_was_changed_is_not_replaced(self):
        shutil.copytree(self.path("out"), self.path("changed"))
        self.tried(self.path("rig.glb"), "--allow-partial", into="changed")  # the scene of a trial is
        with open(self.path("changed", "scene.toml"), "a", encoding="utf-8") as file:
            file.write("# my own line")
        self.assertIn("expected another folder", self.refused("try", self.path("rig.glb"), "-o", self.path("changed"), "--no-reference"))
        self.assertIn("# my own line", self.read("changed", "scene.toml"))

    def test_the_surface_is_written_as_a_file_that_others_open(self):
        self.assertEqual(self.facts["frames"], 3)
        model = skin_formula.Model(self.path("out", "frames", "pbs.glb"))
        primitive = model.document["meshes"][0]["primitives"][0]
        first = model.numbers(primitive["attributes"]["POSITION"])
        changes = [numpy.zeros_like(first), *(model.numbers(target["POSITION"]) for target in primitive["targets"])]
        self.assertEqual(len(changes), 3)
        weights = model.numbers(model.document["animations"][0]["samplers"][0]["output"])
        self.assertEqual(weights.reshape(3, 2).tolist(), [[0, 0], [1, 0], [0, 1]])
        for frame, change in enumerate(changes):
            points = first + change
            expected = points_of(self.path("out", "frames", f"pbs_surface_{frame:06}.vtp"))
            self.assertLess(abs(points - expected).max(), 1e-6)  # single precision, 1 m


class OwnCharacter(TrialTest):
    # Errors that once had no message.

    def test_a_container_is_no_bone(self):
        facts, _ = self.tried(self.rig("scaled_container"))
        self.assertEqual(facts["model"]["joints"], list(rig_files.JOINTS))
        self.assertEqual(facts["model"]["containers"], ["RootNode", "Armature"])

    def test_the_bind_pose_is_the_rest_pose(self):
        facts, _ = self.tried(self.rig("bind_pose_is_not_rest"))
        self.assertAlmostEqual(facts["model"]["bind_pose_deg"], 40.0, delta=1e-3)
        self.assertEqual(facts["volume"]["lbs"]["most_inverted_tets"], 0)

    def test_every_animation_can_be_chosen_and_an_unknown_one_lists_them(self):
        facts, printed = self.tried(self.rig("two_animations"), "--animation", "Twist")
        self.assertEqual(facts["model"]["animations"], ["Bend", "Twist"])
        self.assertEqual([(one["name"], round(one["largest_rotation_deg"])) for one in facts["animations"]], [("Bend", 79), ("Twist", 90)])
        self.assertIn("Animations of the model", self.read("out", "report.html"))
        self.assertNotIn("2 animations", printed)
        self.assertIn("expected one of Bend, Twist", self.refused("try", self.rig("two_animations"), "--animation", "Walk"))

    def test_a_clip_that_matches_too_few_joints_is_refused(self):
        walk = self.write("walk.bvh", clip(["root", "a", "b", "c", "d"]))
        message = self.refused("try", self.rig(), "--animation", walk, "-o", self.path("out"), "--no-reference")
        self.assertIn("1 of 5 moving joints", message)
        self.assertIn("a, b, c, d", message)
        self.tried(self.rig(), "--animation", walk, "--allow-partial")

    # Warnings.

    def test_warnings(self):
        still = [(1, "rotation", [0.0, 1.0], [rig_files.turn((0, 0, 1), 0)] * 2, "LINEAR")]
        for words, variant, options in (
                ("no joint moves", "plain", {"animations": (), "extra": [("Still", still)]}), ("unlikely units", "centimetres", {}),
                ("bones lie outside the body", "plain", {"shifted_m": (0.0, 3.0, 0.0)}),
                ("are without flesh", "plain", {"tiny_tip": True}), ("inverted tets in the first frame", "plain", {"first_deg": 170.0}),
                ("it has no animation: the joint elbow is bent", "no_animation", {}),
                ("it has 2 animations; Bend is taken", "two_animations", {})):
            with self.subTest(words):
                self.warned(*self.tried(self.rig(variant, **options)), words)

    def test_some_joints_of_a_clip_do_not_match(self):
        walk = self.write("walk.bvh", clip(["root", "elbow", "wrist"]))
        self.warned(*self.tried(self.rig(), "--animation", walk), "2 of 3 moving joints of the clip match a bone; without a bone: wrist")

    def test_units_can_be_stated(self):
        facts, printed = self.tried(self.rig("centimetres"), "--scale", "0.01")
        self.assertNotIn("unlikely units", printed)
        self.assertAlmostEqual(facts["model"]["extent_m"], 1.036, places=3)

    def test_a_note_where_nothing_is_wrong(self):
        facts, printed = self.tried(self.rig(first_deg=115.0), vertices="2000")
        words = "inverted tets in the first frame, of"
        self.assertEqual([words in note for note in facts["notes"]], [True])
        self.assertIn(f"pbskin: note: {self.path('out', facts['notes'][0])}\n", printed)
        self.assertFalse(any(words in warning for warning in facts["warnings"]))

    # The reference, and what the page shows.

    @unittest.skipUnless(HAS_FEM, "the finite elements are not installed")
    def test_a_root_on_the_ground_is_left_out_of_the_reference(self):
        facts, printed = self.tried(self.rig(on_ground=True), without=())
        self.warned(facts, printed, "nh_p1 leaves out 1 of 4 bones, whose middle lies outside the flesh: ground")
        self.assertEqual(facts["nearer"]["of"], 2)  # the first frame is at rest

    @unittest.skipUnless(HAS_FEM, "the finite elements are not installed")
    def test_a_model_with_one_joint(self):
        facts, _ = self.tried(self.rig(one_joint=True), without=())
        self.assertIn("No flesh deforms", facts["summary"])
        self.assertNotIn("error at the joints", self.read("out", "report.html"))
        self.assertEqual(self.shown()["reference"], "nh_p1")

    def test_without_the_finite_elements_the_trial_has_no_reference(self):
        os.mkdir(self.path("modules"))
        for file in MODULES:
            if "_fem" not in file:
                os.symlink(os.path.realpath(file), self.path("modules", os.path.basename(file)))
        self.warned(*self.tried(self.rig(), without=(), PBSKIN_MODULES=self.path("modules")),
                    "the trial has no reference: libpbskin_fem.so: ")
        self.assertEqual(self.shown()["reference"], "")

    def test_models_of_a_centimetre_and_of_ten_kilometres_are_shown(self):
        for scale, extent_m in (("0.01", 0.01036), ("10000", 10360.0)):
            self.tried(self.rig(), "--scale", scale)
            self.assertAlmostEqual(65535 * self.shown()["step_m"] / extent_m, 1.0, delta=0.1)  # over all frames

    # What the files are for.

    def test_run_explains_what_a_scene_is(self):
        self.assertRegex(self.refused("run", self.rig()), "is a model(.|\n)*pbskin try")

    def test_a_body_by_name_is_no_exception(self):
        self.write("walk.bvh", clip(["upper", "a", "b"]))
        scene = f"""schema = 1
[character]
body = "limb"
vertices = 300
[motion]
clip = "walk.bvh"
rate_hz = 10.0
{foreign_arm.PBS}[deformers]
use = ["lbs"]
"""
        scene = self.write("limb.toml", scene)
        self.assertIn("joints = 1 of 3 moving joints: expected at least one half", self.refused("run", scene, "-o", self.path("run")))
        printed = self.succeeds("run", scene, "-o", self.path("run"), "--set", "motion.allow_partial=true").stderr
        words = "1 of 3 moving joints of the clip match a bone; without a bone: a, b; bones without a motion of their own: forearm"
        self.assertIn(words, printed)
        self.assertIn(f"walk.bvh: {words}", self.json("run", "run.json")["outcome"]["warnings"])

    def test_a_trial_that_was_interrupted_runs_again(self):
        slow = [(1, "rotation", [0.0, 100.0], [rig_files.turn((0, 0, 1), 0), rig_files.turn((0, 0, 1), 60)], "LINEAR")]
        command = [program.PBSKIN, "try", self.rig(animations=(), extra=[("Slow", slow)]), "-o", self.path("out"), "--no-reference"]
        with subprocess.Popen([*command, "--frames", "3000", "--vertices", "300"], stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None and not os.path.exists(self.path("out", "frames", "lbs_000001.vtu")):
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(), 130, process.stderr.read())
        self.assertFalse(os.path.exists(self.path("out", "run.json")))
        self.tried(self.path("rig.glb"))
        self.assertEqual(self.json("out", "run.json")["outcome"]["frames"], 3)

    def test_the_folder_of_another_model_is_refused_and_kept(self):
        self.tried(self.rig())
        other, before = rig_files.write("two_animations", self.path("other.glb")), self.read("out", "try.json")
        message = self.refused("try", other, "-o", self.path("out"), "--no-reference")
        self.assertIn("character.model = ../rig.glb: the folder has the trial of this model: expected another folder (-o)", message)
        self.assertIn(other, message)
        self.assertEqual(self.read("out", "try.json"), before)

    def test_a_joint_that_only_moves_along_is_no_warning(self):
        slide = [(2, "translation", [0.0, 1.0], [[0.35, 0, 0], [0.45, 0, 0]], "LINEAR")]
        facts, _ = self.tried(self.rig(animations=(), extra=[("Slide", slide)]))
        self.assertFalse(any("no joint moves" in warning for warning in facts["warnings"]), facts["warnings"])


if __name__ == "__main__":
    unittest.main()
