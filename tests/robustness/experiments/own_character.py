"""Rigs from outside: each error that once passed without a message has a test here, and each warning is provoked. What a trial leaves is
judged too: the .glb files by the rules of glTF 2.0 and by the model's own bytes, the artist's surface as a control for every kind of
motion. The rigs are those of rig_files.py and block_rigs.py."""
import csv
import glob
import html
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

import block_rigs
import foreign_arm
import program
import rig_files
import skin_formula
from written_frames import points_of

FRAMES, FAR_FROM_ARTIST_PCT = 3, 2.0  # above which the program warns, of the model's size
ROUNDED_M = 1.04 * 2.0 ** -24  # a coordinate of the tube in single precision, as in .glb files
PNG = b"\x89PNG\r\n\x1a\nof a test"
UV = numpy.linspace(0, 1, 2 * len(rig_files.tube()[0])).reshape(-1, 2)


def turned(degrees, joint=1):
    """Channels of an animation whose joint turns by this angle within a second."""
    return [(joint, "rotation", [0.0, 1.0], [rig_files.turn((0, 0, 1), angle) for angle in (0, degrees)], "LINEAR")]


def reversed_by_a_third():
    """The tube, a third of whose triangles face inwards: its signed volume is a third of its own."""
    points, triangles = rig_files.tube()
    third = len(triangles) // 3
    return points, numpy.concatenate([triangles[:third, ::-1], triangles[third:]])


def clip(names):
    """A BVH chain of these joints, all of which turn."""
    frames = [["0 0 0", *([f"{20 * frame} 0 0"] * len(names))] for frame in range(4)]
    return foreign_arm.bvh(names, frames, 0.1, 0.3)


def painted(path):
    """The plain rig with normals, texture coordinates, two materials, an image in the file and one that is nowhere."""
    gltf = rig_files.Gltf()
    gltf.document, gltf.bytes = rig_files.rig()
    points, triangles = rig_files.tube()
    first = gltf.document["meshes"][0]["primitives"][0]
    first["attributes"]["NORMAL"] = gltf.put(points / numpy.linalg.norm(points, axis=1).clip(1e-9)[:, None], "VEC3", rig_files.FLOAT)
    first["attributes"]["TEXCOORD_0"] = gltf.put(UV, "VEC2", rig_files.FLOAT)
    parts = [gltf.put(part.reshape(-1, 1), "SCALAR", rig_files.UNSIGNED_INT) for part in (triangles[:100], triangles[100:])]
    gltf.document["meshes"][0]["primitives"] = [{"attributes": dict(first["attributes"]), "indices": indices, "material": material}
                                                for indices, material in zip(parts, (1, 0))]
    view = gltf.document["accessors"][gltf.put(numpy.frombuffer(PNG, "u1"), "SCALAR", rig_files.UNSIGNED_BYTE)]["bufferView"]
    gltf.document.update(images=[{"bufferView": view, "mimeType": "image/png"}, {"uri": "nowhere.png"}],
                         textures=[{"source": 0}, {"source": 1}], materials=[
                             {"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": n}}} for n, name in enumerate("ab")])
    return rig_files.write_glb(path, {**gltf.document, "buffers": [{"byteLength": len(gltf.bytes)}]}, gltf.bytes)


class TrialTest(program.ProgramTest):
    def rig(self, variant="plain", **options):
        """One name for all, so that the cache has one mesh for those with the same surface."""
        return rig_files.write(variant, self.path("rig.glb"), **options)

    def tried(self, model, *arguments, into="out", without=("--no-reference",), vertices="300", frames=FRAMES, **environment):
        """try.json and what was printed. The page has a viewer, whose program does nothing."""
        self.write("viewer.js", "// a viewer")
        process = self.succeeds("try", model, "-o", self.path(into), "--frames", frames, "--vertices", vertices, *without, *arguments,
                                env={**os.environ, "PBS_VIEWER_BUILD": self.folder, **environment})
        return self.json(into, "try.json"), process.stdout + process.stderr

    def refused(self, *arguments):
        return self.ends(2, *arguments).stderr

    def remarked(self, facts, printed, words, kind="warning"):
        """Once in the terminal, in run.json, in try.json and in the page, and only as this kind of remark."""
        self.assertEqual(len(re.findall(f"pbskin: {kind}: .*{re.escape(words)}", printed)), 1, printed)
        for recorded in (facts, self.json("out", "run.json")["outcome"]):
            counts = [sum(words in remark for remark in recorded[kinds]) for kinds in ("warnings", "notes")]
            self.assertEqual(counts, [1, 0] if kind == "warning" else [0, 1], recorded)
        for text in (printed, html.unescape(self.read("out", "report.html"))):
            self.assertEqual(text.count(words), 1, words)

    def points(self, *name):
        """Of the surfaces in these files, in the order of the frames."""
        return [points_of(file) for file in sorted(glob.glob(self.path("out", *name)))]

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
            self.assertLess(abs(points - expected).max(), 3 * ROUNDED_M)  # the first points, the change, their sum


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
        self.assertEqual([(one["name"], round(one["largest_rotation_deg"])) for one in facts["animations"]], [("Bend", 70), ("Twist", 90)])
        self.assertIn("Animations of the model", self.read("out", "report.html"))
        self.assertNotIn("2 animations", printed)
        self.assertIn("expected one of Bend, Twist", self.refused("try", self.rig("two_animations"), "--animation", "Walk"))

    def test_an_animation_of_a_clip_can_be_chosen_by_name(self):
        clip = os.path.join(self.folder, "clip:of two.glb")
        os.rename(self.rig("two_animations"), clip)
        facts, printed = self.tried(self.rig(), "--animation", f"{clip}:Twist")
        self.assertNotIn("2 animations", printed)
        scene = self.read("out", "scene.toml")
        self.assertIn('animation = "Twist"', scene)
        self.assertIn("clip:of two.glb", scene)
        facts, printed = self.tried(self.rig(), "--animation", clip)
        self.remarked(facts, printed, "Bend is taken, the first one that turns a joint by more than 5 degrees", "note")
        for model in ("plain", "no_animation"):
            message = self.refused("try", self.rig(model), "--animation", f"{clip}:Walk")
            self.assertIn("clip:of two.glb: animation = Walk: expected one of Bend, Twist", message)

    def test_a_clip_that_matches_too_few_joints_is_refused(self):
        walk = self.write("walk.bvh", clip(["root", "a", "b", "c", "d"]))
        message = self.refused("try", self.rig(), "--animation", walk, "-o", self.path("out"), "--no-reference")
        self.assertIn("1 of 5 moving joints", message)
        self.assertIn("a, b, c, d", message)
        self.tried(self.rig(), "--animation", walk, "--allow-partial")

    # Warnings.

    def test_warnings(self):
        for words, variant, options in (
                ("no joint moves", "plain", {"animations": (), "extra": [("Still", turned(0))]}), ("unlikely units", "centimetres", {}),
                ("bones lie outside the body", "plain", {"shifted_m": (0.0, 3.0, 0.0)}),
                ("are without flesh", "plain", {"tiny_tip": True}), ("inverted tets in the first frame", "plain", {"first_deg": 170.0}),
                ("times the volume that the surface seems to enclose", "plain", {"surface": reversed_by_a_third()}),
                ("it has 2 animations; Bend is taken", "two_animations", {})):
            with self.subTest(words):
                facts, printed = self.tried(self.rig(variant, **options))
                self.remarked(facts, printed, words, "note" if words.startswith("it has") else "warning")
                if "surface" in options:  # which has no volume to be measured
                    self.remarked(facts, printed, "surface_volume_change_pct is empty", "note")

    def test_at_most_three_warnings_the_gravest_first(self):
        """A rig of centimetres, whose animation begins far from its bind pose, with a tip that the tets do not carry and bones above the
        body: what makes results wrong comes first, and what is beyond three warnings is a note."""
        facts, printed = self.tried(self.rig("centimetres", first_deg=170.0, tiny_tip=True, shifted_m=(0.0, 300.0, 0.0)))
        self.assertEqual(len(facts["warnings"]), 3)
        self.assertIn("inverted tets in the first frame", facts["warnings"][0])
        self.assertEqual(len(re.findall("pbskin: warning: ", printed)), 3, printed)
        said = [printed.index(text.split(": ", 1)[1]) for text in facts["warnings"]]
        self.assertEqual(said, sorted(said), printed)
        page = html.unescape(self.read("out", "report.html"))
        places = [page.index(text) for text in (*facts["warnings"], *facts["notes"])]
        self.assertEqual(places, sorted(places))

    def test_bones_that_move_apart(self):
        """Squash and stretch: the elbow goes half as far again from the root. Neither the sentence nor the page judges the volume."""
        away = numpy.array([rig_files.PLACES[1], 1.5 * numpy.array(rig_files.PLACES[1])]) - rig_files.PLACES[0]
        model = self.rig(animations=(), extra=[("Stretch", [(1, "translation", [0.0, 1.0], away, "LINEAR")])])
        facts, printed = self.tried(model)
        (bone,) = facts["motion"]["stretched_bones"]
        self.assertEqual((bone["bone"], bone["frame"]), ("elbow", FRAMES - 1))
        self.assertAlmostEqual(bone["change_pct"], 50.0, delta=1e-3)
        self.remarked(facts, printed, "elbow by +50 % in frame 2; the artist changes the volume with it")
        self.assertNotIn("volume", facts["summary"])
        self.assertNotIn("Volume at the joints", self.read("out", "report.html"))

    def test_without_the_program_of_the_viewer_the_page_keeps_what_it_shows(self):
        """All frames, so that the large files are removed, and `pbskin report` adds the program as soon as it is built."""
        _, printed = self.tried(self.rig(), PBS_VIEWER_BUILD=self.path("nowhere"))
        self.assertIn("viewer.js is not built", printed)
        self.assertEqual(glob.glob(self.path("out", "frames", "*.vtu")), [])
        self.assertEqual(len(self.shown()["frames"]), FRAMES)
        self.assertNotIn("// a viewer", self.read("out", "report.html"))
        self.succeeds("report", self.path("out"), env={**os.environ, "PBS_VIEWER_BUILD": self.folder})
        self.assertIn("// a viewer", self.read("out", "report.html"))
        self.assertEqual(len(self.shown()["frames"]), FRAMES)

    def test_a_body_with_a_handle(self):
        """A ring has one of its own, and parts that grow together make one more."""
        self.assertNotIn("handle", self.tried(block_rigs.write_ring(self.path("ring.glb")), into="ring")[1])
        self.remarked(*self.tried(block_rigs.write_ring(self.path("open.glb"), gap=0.004)), "1 handles, and the model has 0")

    def test_parts_that_cannot_be_cut_apart(self):
        """Of two shoes the right one has its bone far above. The left leg turns by 30 degrees in the last frame."""
        facts, printed = self.tried(block_rigs.write_shoes(self.path("shoes.glb"), far_bone=True))
        followed = facts["from_artist"]
        self.assertEqual([followed[name] for name in ("bone_of_flesh", "bone", "frame")], ["leg.L", "leg.R", FRAMES - 1])
        # The difference of two coordinates of up to 0.15 m in single precision, [mm]
        self.assertAlmostEqual(followed["gap_mm"], 1e3 * block_rigs.SHOES_GAP, delta=1e3 * 2 * 0.15 * 2.0 ** -24)
        size_m = numpy.linalg.norm(numpy.ptp(skin_formula.Model(self.path("shoes.glb")).points(None, None), axis=0))
        self.remarked(facts, printed, f"the surface that LBS carries with the tets is up to {followed['largest_pct']:.1f} % of the model's "
                      "size away from the artist's, in frame 2: there the flesh of leg.L carries the surface of leg.R, with a gap of "
                      f"{100 * block_rigs.SHOES_GAP / size_m:.2g} % of that size")
        self.assertEqual(self.json("out", "run.json")["outcome"]["from_artist"], followed)

    def test_a_clip_of_which_some_joints_do_not_match(self):
        """The surface that the tets carry is as far from the artist's as the trial states, and below the bound of a warning."""
        walk = self.write("walk.bvh", clip(["root", "elbow", "wrist"]))
        facts, printed = self.tried(self.rig(), "--animation", walk, "--paraview")
        self.remarked(facts, printed, "2 of 3 moving joints of the clip match a bone; without a bone: wrist")
        self.assertAlmostEqual(facts["motion"]["time_zero_s"], 0.1)  # after the T pose
        artist, lbs = self.points("skin", "artist_*.vtp"), self.points("frames", "lbs_surface_*.vtp")
        self.assertEqual((len(artist), len(lbs)), (FRAMES, FRAMES))
        # The root turns by 20 degrees from frame to frame, so that the end of the tube, 1 m away, moves by more than 2 sin(20 degrees) / 2.
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
        rest, (weights, place) = rig_files.tube()[0], (rig_files.weights_of(rig_files.tube()[0]), numpy.array(rig_files.PLACES[1]))
        axis = numpy.array(json.loads(re.search("axis = (.*)", self.read("out", "scene.toml"))[1]))
        for frame, found in enumerate(self.points("skin", "artist_*.vtp")):
            turn = skin_formula.quaternion_matrix(numpy.array(rig_files.turn(axis, 60.0 * frame / (FRAMES - 1))))
            expected = weights[:, :1] * rest + (1 - weights[:, :1]) * ((rest - place) @ turn.T + place)
            self.assertLess(abs(found - expected).max(), 3 * ROUNDED_M)  # points, places, and weights of up to 1 m
        self.assertEqual(frame, FRAMES - 1)

    def test_a_body_that_turns_as_a_whole_moves_no_joint(self):
        model = self.rig(animations=(), extra=[("Turntable", turned(120, joint=0)), ("Bend", turned(60))])
        facts, _ = self.tried(model)
        self.assertEqual(facts["model"]["animation"], "Bend")
        self.assertEqual([round(one["largest_rotation_deg"]) for one in facts["animations"]], [0, 60])

    def test_an_animation_of_one_key_is_a_pose(self):
        model = self.rig(animations=(), extra=[("Pose", [(1, "rotation", [0.0], [rig_files.turn((0, 0, 1), 60)], "LINEAR")])])
        facts, printed = self.tried(model)
        self.remarked(facts, printed, "the motion is one pose, in which the bones are turned by up to 60 degrees from the rest pose")
        self.assertNotIn("no joint moves", printed)
        [found] = self.points("skin", "artist_*.vtp")
        self.assertLess(abs(found - skin_formula.Model(model).points("Pose", 0.0)).max(), 3 * ROUNDED_M)

    def test_a_body_whose_faces_are_doubled_is_as_large_as_the_plain_one(self):
        """The second sides and 300 points that no triangle uses, far away."""
        points, triangles = rig_files.tube()
        doubled = numpy.vstack([points, numpy.full((300, 3), 30.0)]), numpy.vstack([triangles, triangles[:, ::-1]])
        facts, printed = self.tried(self.rig(surface=doubled))
        self.remarked(facts, printed, f"{len(triangles)} of {2 * len(triangles):,} triangles of mesh tube are the second side of others")
        self.remarked(facts, printed, f"300 of {len(points) + 300} points of mesh tube are left out")
        plain, _ = self.tried(self.rig(), into="plain")
        self.assertEqual(facts["volume"], plain["volume"])

    def test_an_empty_first_take_and_equal_names(self):
        """A take without channels is left out, and the first of the others is still."""
        model = self.rig(animations=(), extra=[("Take 001", channels) for channels in ([], turned(0), turned(60))])
        facts, printed = self.tried(model)
        self.remarked(facts, printed, "it has 2 animations; Take 001 (2) is taken", "note")
        for arguments in ((), ("--animation", "Take 001 (2)")):
            facts, _ = self.tried(model, *arguments)
            self.assertEqual(facts["model"]["animation"], "Take 001 (2)")
            self.assertEqual([(one["name"], round(one["largest_rotation_deg"])) for one in facts["animations"]],
                             [("Take 001", 0), ("Take 001 (2)", 60)])
            cells = re.findall(r"<t[hd][^>]*>([^<]*)</t[hd]>", self.read("out", "report.html").split("Animations of the model")[2])
            self.assertEqual(cells[4:12:4] + cells[7:12:4], ["Take 001", "Take 001 (2)", "", "yes"])

    def test_units_can_be_stated(self):
        facts, printed = self.tried(self.rig("centimetres"), "--scale", "0.01")
        self.assertNotIn("unlikely units", printed)
        self.assertAlmostEqual(facts["model"]["extent_m"], 1.036, places=3)

    def test_a_note_where_nothing_is_wrong(self):
        facts, printed = self.tried(self.rig(first_deg=115.0), vertices="2000")
        self.remarked(facts, printed, "inverted tets in the first frame, of", "note")

    # The reference, and what the page shows.

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_a_root_on_the_ground_is_left_out_of_the_reference(self):
        facts, printed = self.tried(self.rig(on_ground=True), without=())
        self.remarked(facts, printed, "nh_p1 leaves out 1 of 4 bones, whose middle lies outside the flesh: ground")
        self.assertEqual(facts["nearer"]["joints"]["of"], 2)  # the first frame is at rest

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_the_error_of_the_reference_itself_can_be_bounded(self):
        facts, printed = self.tried(self.rig(), "--error-bar", without=(), vertices="150", frames=2)
        bounds = [float(row["reference_error_joint_pct"]) for row in self.rows("out", "metrics.csv") if row["deformer"] == "pbs"]
        bar = facts["error_bar"]
        self.assertEqual((bar["frames"], bar["of"], bar["largest_pct"]), (2, 2, max(bounds)))
        self.assertGreater(bar["largest_pct"], 0)
        self.assertGreater(bar["seconds"], 0)
        self.assertIn(f"is estimated in 2 of 2 frames, at most {bar['largest_pct']:.2g} %, which took", printed)
        self.assertIn("--error-bar excludes --no-reference", self.refused("try", "rig.glb", "--error-bar", "--no-reference"))

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_a_model_with_one_joint(self):
        facts, _ = self.tried(self.rig(one_joint=True), without=())
        self.assertIn("No flesh deforms", facts["summary"])
        self.assertNotIn("error at the joints [%]", self.read("out", "report.html"))
        self.assertEqual(self.shown()["reference"], "nh_p1")

    def test_without_the_finite_elements_the_trial_has_no_reference(self):
        os.mkdir(self.path("modules"))
        for file in program.MODULES:
            if "_fem" not in file:
                os.symlink(os.path.realpath(file), self.path("modules", os.path.basename(file)))
        self.remarked(*self.tried(self.rig(), without=(), PBSKIN_MODULES=self.path("modules")),
                    "the trial has no reference: libpbskin_fem.so: ")
        self.assertEqual(self.shown()["reference"], "")

    # What the files are for.

    def check_rules(self, model):
        """Khronos: lengths, alignment, bounds, indices, counts."""
        document, (buffer,) = model.document, model.document["buffers"]
        self.assertEqual(len(model.buffers[0]), buffer["byteLength"])
        for view in document["bufferViews"]:
            self.assertLessEqual(view.get("byteOffset", 0) + view["byteLength"], buffer["byteLength"])
        for number, accessor in enumerate(document["accessors"]):
            self.assertEqual(document["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) % 4, 0)
            if "min" in accessor:
                self.assertEqual(model.numbers(number).min(axis=0).tolist(), accessor["min"])
                self.assertEqual(model.numbers(number).max(axis=0).tolist(), accessor["max"])
        for primitive in document["meshes"][0]["primitives"]:
            points = document["accessors"][primitive["attributes"]["POSITION"]]["count"]
            self.assertLess(model.numbers(primitive["indices"]).max(), points)
            for of in (primitive["attributes"], *primitive["targets"]):
                self.assertTrue(all(document["accessors"][accessor]["count"] == points for accessor in of.values()))
                self.assertIn("min", document["accessors"][of["POSITION"]])

    def test_the_glb_has_the_artists_look_and_the_frames_are_gone(self):
        source = skin_formula.Model(painted(self.path("rig.glb")))
        _, printed = self.tried(self.path("rig.glb"))
        self.assertIn("left out of the .glb files: image nowhere.png: expected PNG or JPEG", printed)
        self.assertRegex(printed, r"out: [0-9.]+ MB in \d+ files, without frames for ParaView")
        kept = {os.path.relpath(file, self.path("out")) for file in glob.glob(self.path("out", "*", "*"))}
        self.assertEqual({os.path.splitext(file)[1] for file in kept if file.startswith("frames")}, {".glb"})
        self.assertEqual(sum(file.endswith(".vtp") for file in kept), FRAMES)
        for name in ("lbs", "pbs"):
            model = skin_formula.Model(self.path("out", "frames", f"{name}.glb"))
            self.check_rules(model)
            self.assertEqual([material["name"] for material in model.document["materials"]], ["a", "b"])
            self.assertIn(PNG, model.buffers[0])
            parts = {part["material"]: part for part in model.document["meshes"][0]["primitives"]}
            for own in source.document["meshes"][0]["primitives"]:
                part = parts[own["material"]]
                found, wanted = model.numbers(part["indices"]), source.numbers(own["indices"])
                self.assertEqual(found.ravel().tolist(), wanted.ravel().tolist())  # both primitives share their points
                uv = model.numbers(part["attributes"]["TEXCOORD_0"])
                self.assertEqual(uv.tolist(), source.numbers(own["attributes"]["TEXCOORD_0"]).tolist())
                normals = [model.numbers(part["attributes"]["NORMAL"])]
                normals += [normals[0] + model.numbers(target["NORMAL"]) for target in part["targets"]]
                # Three components of the first normal, of its change of up to 2, and of their sum.
                self.assertLess(abs(numpy.linalg.norm(normals, axis=2) - 1).max(), 4 * numpy.sqrt(3) * 2.0 ** -24)

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
        command = [program.PBSKIN, "try", self.rig(animations=(), extra=[("Slow", turned(60))]), "-o", self.path("out"), "--no-reference"]
        with subprocess.Popen([*command, "--frames", "3000", "--vertices", "300"], stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None and not os.path.exists(self.path("out", "frames", "lbs_000001.vtu")):
                time.sleep(0.01)
            process.send_signal(signal.SIGINT)
            printed = process.stderr.read()
            self.assertEqual(process.wait(), 130, printed)
        self.assertIn("report.html has what was finished", printed)
        self.assertTrue(self.json("out", "try.json")["interrupted"])
        frames = self.json("out", "run.json")["outcome"]["frames"]
        self.assertTrue(1 < frames < 3000, frames)
        self.assertEqual({row["frame"] for row in self.rows("out", "metrics.csv")}, set(map(str, range(frames))))
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


class TouchingParts(TrialTest):
    """Parts that nearly touch at rest and move apart: their tets are separated, so that the surface follows the artist's, as the skinning
    formula of glTF has it, within the bound of the warning."""

    def check(self, model_file, first, second):
        facts, printed = self.tried(model_file, "--paraview", vertices="2000")
        model, files = skin_formula.Model(model_file), self.points("frames", "lbs_surface_*.vtp")
        self.assertEqual(len(files), FRAMES)
        size = numpy.linalg.norm(numpy.ptp(model.points(None, None), axis=0))
        farthest = max(numpy.linalg.norm(points - model.points("Move", frame / (FRAMES - 1)), axis=1).max()
                       for frame, points in enumerate(files)) / size
        self.assertLess(100.0 * farthest, FAR_FROM_ARTIST_PCT)
        rounded_pct = FAR_FROM_ARTIST_PCT * 2 * 2.0 ** -24  # of the size, the distance of two points that the file has in single precision
        self.assertAlmostEqual(facts["from_artist"]["largest_pct"], 100.0 * farthest, delta=rounded_pct)
        self.assertRegex(printed, f"the flesh is cut between ({first} and {second}|{second} and {first})")
        self.assertIn("of the model&#x27;s size", self.read("out", "report.html"))

    def test_both_shoes_follow(self):
        self.check(block_rigs.write_shoes(self.path("shoes.glb")), "leg.L", "leg.R")

    def test_the_jaw_opens(self):
        self.check(block_rigs.write_mouth(self.path("mouth.glb")), "head", "jaw")

    def test_no_bone_of_the_jaw_holds_the_teeth_above(self):
        """Above the mouth and in front of its corners the artist's weight of the jaw is 0, although its bone is the nearest one. The cut
        between tets of 2 cm lies at most that far from the mouth. PBS keeps these teeth, so that it opens more than half of the mouth."""
        self.tried(block_rigs.write_mouth(self.path("mouth.glb")), "--paraview", without=(), vertices="2000")
        x, y, z = self.points("frames", "pbs_000000.vtu")[0].T
        above = (y > 0.08) & (z > 0.05)
        rows = csv.DictReader(self.read("out", "binding.csv").splitlines())
        bound = [row["bone"] for row, is_above in zip(rows, above, strict=True) if is_above]
        self.assertGreater(len(bound), 100)
        self.assertEqual(bound.count("jaw"), 0)
        bones = {bone["bone"]: bone for bone in self.json("out", "run.json")["deformers"]["nh_p1"]["attachment"]["bones"]}
        self.assertLess(bones["jaw"]["samples"], bones["head"]["samples"])  # springs
        model = skin_formula.Model(self.path("mouth.glb"))
        rest, found, artist = model.points(None, None), self.points("frames", "pbs_surface_*.vtp")[-1], model.points("Move", 1.0)
        upper, lower = ((rest[:, 2] > 0.05) & (abs(rest[:, 1] - at) < 1e-6) for at in (0.05 + block_rigs.MOUTH_GAP, 0.05))
        opening, expected = (points[upper, 1].mean() - points[lower, 1].mean() for points in (found, artist))
        self.assertGreater(opening, 0.5 * expected)


if __name__ == "__main__":
    unittest.main()
