"""What a trial leaves: its page with the reference, its .glb files, judged by the rules of glTF 2.0 and by the model's
own bytes, and its folder after an interruption and for another model."""
import glob
import os
import signal
import subprocess
import time
import unittest

import numpy

import program
import rig_files
import skin_formula
from trial_test import FRAMES, TrialTest, turned

PNG = b"\x89PNG\r\n\x1a\nof a test"
UV = numpy.linspace(0, 1, 2 * len(rig_files.tube()[0])).reshape(-1, 2)


def painted(path):
    """The plain rig with normals, texture coordinates, two materials, an image in the file and one that is nowhere."""
    gltf = rig_files.Gltf()
    gltf.document, gltf.bytes = rig_files.rig()
    points, triangles = rig_files.tube()
    first = gltf.document["meshes"][0]["primitives"][0]
    first["attributes"]["NORMAL"] = gltf.put(points / numpy.linalg.norm(points, axis=1).clip(1e-9)[:, None], "VEC3",
                                             rig_files.FLOAT)
    first["attributes"]["TEXCOORD_0"] = gltf.put(UV, "VEC2", rig_files.FLOAT)
    parts = [gltf.put(part.reshape(-1, 1), "SCALAR", rig_files.UNSIGNED_INT)
             for part in (triangles[:100], triangles[100:])]
    gltf.document["meshes"][0]["primitives"] = [{"attributes": dict(first["attributes"]), "indices": indices,
                                                 "material": material}
                                                for indices, material in zip(parts, (1, 0))]
    view = gltf.document["accessors"][gltf.put(numpy.frombuffer(PNG, "u1"), "SCALAR",
                                               rig_files.UNSIGNED_BYTE)]["bufferView"]
    gltf.document.update(images=[{"bufferView": view, "mimeType": "image/png"}, {"uri": "nowhere.png"}],
                         textures=[{"source": 0}, {"source": 1}], materials=[
                             {"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": n}}}
                             for n, name in enumerate("ab")])
    return rig_files.write_glb(path, {**gltf.document, "buffers": [{"byteLength": len(gltf.bytes)}]}, gltf.bytes)


class TrialFiles(TrialTest):
    def test_without_the_program_of_the_viewer_the_page_keeps_what_it_shows(self):
        """All frames, so that the large files are removed, and `pbskin report` adds the program as soon as it is
        built."""
        _, printed = self.tried(self.rig(), PBS_VIEWER_BUILD=self.path("nowhere"))
        self.assertIn("viewer.js is not built", printed)
        self.assertEqual(glob.glob(self.path("out", "frames", "*.vtu")), [])
        self.assertEqual(len(self.shown()["frames"]), FRAMES)
        self.assertNotIn("// a viewer", self.read("out", "report.html"))
        self.succeeds("report", self.path("out"), env={**os.environ, "PBS_VIEWER_BUILD": self.folder})
        self.assertIn("// a viewer", self.read("out", "report.html"))
        self.assertEqual(len(self.shown()["frames"]), FRAMES)

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_a_root_on_the_ground_is_left_out_of_the_reference(self):
        walks = [("Bend", turned(60) + turned(15, joint=0))]  # the ground stays
        facts, printed = self.tried(self.rig(on_ground=True, animations=(), extra=walks), without=())
        self.remarked(facts, printed, "nh_p1 leaves out 1 of 4 bones, whose middle lies outside the flesh: ground")
        self.assertEqual(facts["nearest"]["frames"], 2)  # the first frame is at rest

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_the_error_of_the_reference_itself_can_be_bounded(self):
        facts, printed = self.tried(self.rig(animations=(), extra=[("Bend", turned(15))]), "--error-bar", without=(),
                                    frames=2)
        bounds = [float(row["reference_error_joint_pct"]) for row in self.rows("out", "metrics.csv")
                  if row["deformer"] == "pbs"]
        bar = facts["error_bar"]
        self.assertEqual((bar["frames"], bar["of"], bar["largest_pct"]), (2, 2, max(bounds)))
        self.assertGreater(bar["largest_pct"], 0)
        self.assertGreater(bar["seconds"], 0)
        self.assertIn(f"is estimated in 2 of 2 frames, at most {bar['largest_pct']:.2g} %, which took", printed)
        self.assertIn("--error-bar excludes --no-reference",
                      self.refused("try", "rig.glb", "--error-bar", "--no-reference"))

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

    def test_a_trial_that_was_interrupted_runs_again_and_is_kept_from_another_model(self):
        command = [program.PBSKIN, "try", self.rig(animations=(), extra=[("Slow", turned(60))]), "-o", self.path("out"),
                   "--no-reference"]
        with subprocess.Popen([*command, "--frames", "3000", "--vertices", "300"], stderr=subprocess.PIPE,
                              text=True) as process:
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
        other, before = rig_files.write("two_animations", self.path("other.glb")), self.read("out", "try.json")
        message = self.refused("try", other, "-o", self.path("out"), "--no-reference")
        self.assertIn("character.model = ../rig.glb: the folder has the trial of this model: expected another "
                      "folder (-o)", message)
        self.assertIn(other, message)
        self.assertEqual(self.read("out", "try.json"), before)

    @unittest.skipUnless(program.HAS_FEM, "built without the finite elements")
    def test_an_interrupted_trial_ends_with_a_page_and_goes_on(self):
        """An interruption ends the solving of the reference alone."""
        self.write("viewer.js", "// a viewer")
        words = ["try", self.rig(), "-o", self.path("out"), "--frames", "12", "--vertices", "300"]
        environment = {**os.environ, "PBS_VIEWER_BUILD": self.folder}
        with subprocess.Popen([program.PBSKIN, *words], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                              env=environment) as trial:
            printed = ""
            while "solving the reference" not in printed:
                line = trial.stderr.readline()
                self.assertTrue(line, printed)
                printed += line
            trial.send_signal(signal.SIGTERM)
            printed += trial.stderr.read()
            self.assertEqual(trial.wait(), 130, printed)
        self.assertIn("interrupted; what is finished is written now (a second interruption ends this too)", printed)
        self.assertIn("report.html has what was finished, and the same command goes on from there", printed)
        facts = self.json("out", "try.json")
        self.assertTrue(facts["interrupted"])
        self.assertEqual(facts["frames"], 12)  # of the methods
        self.assertLess(facts["reference_frames"]["solved"], 12)
        self.assertIn("<html", self.read("out", "report.html"))
        solved = facts["reference_frames"]["solved"]
        self.succeeds(*words, env=environment)
        facts = self.json("out", "try.json")
        self.assertFalse(facts["interrupted"])
        self.assertEqual((facts["reference_frames"]["kept"], facts["reference_frames"]["solved"]), (solved, 12))


if __name__ == "__main__":
    unittest.main()
