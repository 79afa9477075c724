"""Rigs from outside: each error that once passed without a message has a test here, and each warning is provoked. The rigs are those of
rig_files.py."""
import os
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

def clip(names):
    """A BVH chain of these joints, all of which turn."""
    frames = [["0 0 0", *([f"{20 * frame} 0 0"] * len(names))] for frame in range(4)]
    return foreign_arm.bvh(names, frames, 0.1, 0.3)


class TrialTest(program.ProgramTest):
    def rig(self, variant="plain", **options):
        """One name for all, so that the cache has one mesh for those with the same surface."""
        return rig_files.write(variant, self.path("rig.glb"), **options)

    def tried(self, model, *arguments, into="out"):
        """try.json and what was printed."""
        process = self.succeeds("try", model, "-o", self.path(into), "--no-reference", "--frames", "3", "--vertices", "300", *arguments)
        return self.json(into, "try.json"), process.stderr

    def refused(self, *arguments):
        return self.ends(2, *arguments).stderr

    def warned(self, facts, printed, words):
        """In the terminal, in run.json, in try.json and in the page."""
        self.assertIn(words, printed)
        self.assertTrue(any(words in warning for warning in facts["warnings"]), facts["warnings"])
        recorded = self.json("out", "run.json")["outcome"]["warnings"]
        self.assertTrue(any(words in warning for warning in recorded), recorded)
        self.assertIn(words, self.read("out", "report.html"))


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
            type(self).facts, _ = self.tried(self.rig())

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
