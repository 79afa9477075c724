"""Rigs from outside, tried as users do. The warnings that a trial alone can give are provoked here, and the others in
the unit tests of the scene, the rig and the model. The artist's surface is a control for every kind of motion."""
import html
import json
import os
import re
import tempfile
import unittest

import numpy

import foreign_arm
import rig_files
import skin_formula
from trial_test import FAR_FROM_ARTIST_PCT, FRAMES, ROUNDED_M, TrialTest, turned
from written_frames import points_of


def reversed_by_a_third():
    """The tube, a third of whose triangles face inwards: its signed volume is a third of its own."""
    points, triangles = rig_files.tube()
    third = len(triangles) // 3
    return points, numpy.concatenate([triangles[:third, ::-1], triangles[third:]])


def clip(names):
    """A BVH chain of these joints, all of which turn."""
    frames = [["0 0 0", *([f"{20 * frame} 0 0"] * len(names))] for frame in range(4)]
    return foreign_arm.bvh(names, frames, 0.1, 0.3)


class PlainRig(TrialTest):
    """Tests that read one trial of the plain rig, for each trial takes more than a second, most of it for its page."""
    shared = facts = None

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)

    def setUp(self):
        self.folder = self.shared.name
        if not self.facts:
            type(self).facts, _ = self.tried(self.rig(), "--paraview")

    def begin_folder(self, name):
        """The rest of the test has a folder of its own, so that the shared trial stays."""
        self.folder = self.path(name)
        os.mkdir(self.folder)

    def test_a_leaf_joint_is_a_bone_and_keeps_its_weight(self):
        self.assertIn("tip", self.facts["model"]["joints"])
        # 78.5 if the weights of the tip are lost.
        self.assertGreater(self.facts["model"]["weights_transferred_pct"], 95.0)

    def test_the_artists_weights_are_the_default(self):
        for name, weights in (("default", ""), ("artist", 'weights = "artist"\n'), ("paper", 'weights = "paper"\n')):
            scene = self.read("out", "scene.toml") + f"[skinning]\n{weights}"
            self.succeeds("run", self.write(os.path.join("out", f"{name}.toml"), scene), "-o", self.path(name))
        default, artist, paper = (self.json(name, "run.json")["state_hash"] for name in ("default", "artist", "paper"))
        self.assertEqual(default, artist)
        self.assertEqual(paper["lbs"], default["lbs_paper"])
        self.assertNotEqual(default["lbs"], default["lbs_paper"])

    def test_scaled_containers_and_a_bind_pose_that_is_not_the_rest_pose(self):
        """A container is no bone, and the scale of nodes is that of the skeleton too: the points are in centimetres."""
        self.begin_folder("scaled")
        facts, _ = self.tried(self.rig("scaled_container", rest_deg=40.0))
        self.assertEqual(facts["model"]["joints"], list(rig_files.JOINTS))
        self.assertEqual(facts["model"]["containers"], ["RootNode", "Armature"])
        self.assertAlmostEqual(facts["model"]["bind_pose_deg"], 40.0, delta=1e-3)
        self.assertAlmostEqual(facts["model"]["extent_m"], self.facts["model"]["extent_m"], places=5)
        self.assertEqual(facts["volume"]["lbs"]["most_inverted_tets"], 0)

    def test_the_scene_that_try_writes_can_be_run(self):
        self.succeeds("run", self.path("out", "scene.toml"), "-o", self.path("again"))
        first, again = (self.json(folder, "run.json")["state_hash"] for folder in ("out", "again"))
        self.assertEqual(first, again)

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
            self.assertLess(abs(points - expected).max(), 3 * ROUNDED_M)  # the first points, the change, their sum


class OwnCharacter(TrialTest):
    # Errors that once had no message.

    def test_an_animation_of_a_clip_can_be_chosen_by_name(self):
        clip = os.path.join(self.folder, "clip:of two.glb")
        os.rename(self.rig("two_animations"), clip)
        _, printed = self.tried(self.rig(), "--animation", f"{clip}:Twist")
        self.assertNotIn("2 animations", printed)
        scene = self.read("out", "scene.toml")
        self.assertIn('animation = "Twist"', scene)
        self.assertIn("clip:of two.glb", scene)

    # Warnings.

    def test_a_surface_of_which_a_third_faces_inwards(self):
        facts, printed = self.tried(self.rig("two_animations", surface=reversed_by_a_third(),
                                             shifted_m=(0.0, 3.0, 0.0)))
        for words in ("times the volume that the surface seems to enclose", "bones lie outside the body"):
            self.remarked(facts, printed, words)
        # There is no volume to be measured.
        for words in ("surface_volume_change_pct is empty", "it has 2 animations; Bend is taken"):
            self.remarked(facts, printed, words, "note")

    def test_inverted_tets_in_the_first_frame_are_located(self):
        """The tip is turned by 170 degrees. The flesh around it is blended between elbow and tip alone; the root has
        most flesh."""
        channels = [(2, "rotation", [0.0, 1.0], [rig_files.turn((0, 0, 1), angle) for angle in (170, 0)], "LINEAR")]
        facts, printed = self.tried(self.rig(animations=(), extra=[("Unbend", channels)]))
        place, = re.findall(r"pbs begins with [1-9]\d* inverted tets, most of them at (\w+): ", printed)
        self.assertIn(place, ("elbow", "tip"))
        self.remarked(facts, printed, f"inverted tets, most of them at {place}: what is caught in the first frame "
                                      "may stay so", "note")

    def test_at_most_three_warnings_the_gravest_first(self):
        """A rig of centimetres, whose animation begins far from its bind pose, with a tip that the tets do not carry
        and bones above the body: what makes results wrong comes first, and what is beyond three warnings is a note."""
        facts, printed = self.tried(self.rig("centimetres", first_deg=170.0, tiny_tip=True,
                                             shifted_m=(0.0, 300.0, 0.0)))
        self.assertEqual(len(facts["warnings"]), 3)
        self.assertIn("inverted tets in the first frame", facts["warnings"][0])
        self.remarked(facts, printed, "inverted tets in the first frame")
        self.assertEqual(len(re.findall("pbskin: warning: ", printed)), 3, printed)
        said = [printed.index(text.split(": ", 1)[1]) for text in facts["warnings"]]
        self.assertEqual(said, sorted(said), printed)
        page = html.unescape(self.read("out", "report.html"))
        places = [page.index(text) for text in (*facts["warnings"], *facts["notes"])]
        self.assertEqual(places, sorted(places))

    def test_a_clip_of_which_some_joints_do_not_match(self):
        """The surface that the tets carry is as far from the artist's as the trial states, and below the bound of a
        warning."""
        walk = self.write("walk.bvh", clip(["root", "elbow", "wrist"]))
        facts, printed = self.tried(self.rig(), "--animation", walk, "--paraview")
        self.remarked(facts, printed, "2 of 3 moving joints of the clip match a bone; without a bone: wrist")
        self.assertAlmostEqual(facts["motion"]["time_zero_s"], 0.1)  # after the T pose
        artist, lbs = self.points("skin", "artist_*.vtp"), self.points("frames", "lbs_surface_*.vtp")
        self.assertEqual((len(artist), len(lbs)), (FRAMES, FRAMES))
        # The root turns by 20 degrees from frame to frame, so that the end of the tube, 1 m away, moves by more than 2
        # sin(20 degrees) / 2.
        self.assertGreater(abs(artist[-1] - artist[0]).max(), numpy.sin(numpy.radians(20.0)))
        farthest_m = max(numpy.linalg.norm(one - other, axis=1).max() for one, other in zip(artist, lbs))
        size_m = numpy.linalg.norm(numpy.ptp(rig_files.tube()[0], axis=0))
        rounded_pct = FAR_FROM_ARTIST_PCT * 2 * ROUNDED_M / size_m  # of the size, the distance of two points
        self.assertAlmostEqual(facts["from_artist"]["largest_pct"], 100 * farthest_m / size_m, delta=rounded_pct)
        self.assertLess(facts["from_artist"]["largest_pct"], FAR_FROM_ARTIST_PCT)

    def test_a_bend_has_the_artists_surface_too(self):
        facts, printed = self.tried(self.rig("no_animation"))
        self.remarked(facts, printed, "it has no animation: the joint elbow is bent", "note")
        self.assertEqual((facts["control"], facts["motion"]["time_zero_s"]), ("skin/artist_*.vtp", 0.0))
        rest, (weights, place) = rig_files.tube()[0], (rig_files.weights_of(rig_files.tube()[0]),
                                                       numpy.array(rig_files.PLACES[1]))
        axis = numpy.array(json.loads(re.search("axis = (.*)", self.read("out", "scene.toml"))[1]))
        for frame, found in enumerate(self.points("skin", "artist_*.vtp")):
            turn = skin_formula.quaternion_matrix(numpy.array(rig_files.turn(axis, 60.0 * frame / (FRAMES - 1))))
            expected = weights[:, :1] * rest + (1 - weights[:, :1]) * ((rest - place) @ turn.T + place)
            self.assertLess(abs(found - expected).max(), 3 * ROUNDED_M)  # points, places, and weights of up to 1 m
        self.assertEqual(frame, FRAMES - 1)

    def test_a_body_that_turns_as_a_whole_moves_no_joint_and_units_can_be_stated(self):
        model = self.rig("centimetres", animations=(), extra=[("Turntable", turned(120, joint=0)),
                                                              ("Bend", turned(60))])
        facts, printed = self.tried(model, "--scale", "0.01")
        self.assertNotIn("unlikely units", printed)
        self.assertAlmostEqual(facts["model"]["extent_m"], rig_files.LENGTH + 0.6 * rig_files.RADIUS, places=3)
        self.assertEqual(facts["model"]["animation"], "Bend")
        self.assertEqual([round(one["largest_rotation_deg"]) for one in facts["animations"]], [0, 60])

    def test_an_animation_of_one_key_is_a_pose(self):
        model = self.rig(animations=(),
                         extra=[("Pose", [(1, "rotation", [0.0], [rig_files.turn((0, 0, 1), 60)], "LINEAR")])])
        facts, printed = self.tried(model)
        self.remarked(facts, printed, "the motion is one pose, in which the bones are turned by up to 60 degrees from "
                                      "the rest pose")
        self.assertNotIn("no joint moves", printed)
        [found] = self.points("skin", "artist_*.vtp")
        self.assertLess(abs(found - skin_formula.Model(model).points("Pose", 0.0)).max(), 3 * ROUNDED_M)

    def test_a_note_where_nothing_is_wrong(self):
        facts, printed = self.tried(self.rig(first_deg=115.0))
        self.remarked(facts, printed, "inverted tets in the first frame, of", "note")

    def test_run_explains_what_a_scene_is(self):
        self.assertRegex(self.refused("run", self.rig()), "is a model(.|\n)*pbskin try")


if __name__ == "__main__":
    unittest.main()
