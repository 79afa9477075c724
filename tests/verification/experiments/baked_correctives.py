"""`pbskin try --bake`: the exported file is moved here by the rules of glTF 2.0 (morph targets, then the skin), with
numpy alone, and must be where the program states. Tolerance: numbers in the file are in single precision. A point is
the sum of a rest position and up to sixteen targets, and three joints below each other move it. Each is in error by a
few times 2^-24 of the body's size; 1e-6 is sixteen times 2^-24. """
import csv
import glob
import os
import tempfile
import unittest

import numpy

import program
import rig_files
import skin_formula
from written_frames import points_of

FRAMES, EXACT = 7, 1e-6


class Blended(skin_formula.Model):
    """A model whose first animation also moves the weights of its morph targets."""
    def at(self, time_s):
        animation = self.animation(None)
        channel = next(c for c in animation["channels"] if c["target"]["path"] == "weights")
        sampler = animation["samplers"][channel["sampler"]]
        self.times = self.numbers(sampler["input"])[:, 0]
        self.weights = self.numbers(sampler["output"]).reshape(len(self.times), -1)
        self.row = int(numpy.argmin(abs(self.times - time_s)))
        return self.points(None, time_s)

    def unskinned(self, n, primitive):
        points = super().unskinned(n, primitive)
        for weight, target in zip(self.weights[self.row], primitive["targets"], strict=True):
            points = points + weight * self.numbers(target["POSITION"])
        return points


def rms(a, b):
    return numpy.sqrt(((a - b) ** 2).sum(axis=1).mean())


class BakedCorrectivesTest(program.ProgramTest):
    """Tests that read one trial with --bake."""
    shared = baking = None

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)

    def setUp(self):
        self.folder = self.shared.name
        if not self.baking:
            type(self).baking = self.tried("out", "--bake", "--paraview")

    def tried(self, into, *arguments):
        model = rig_files.write("plain", self.path("rig.glb"))
        return self.succeeds("try", model, "-o", self.path(into), "--frames", FRAMES, "--vertices", "300", *arguments)

    def surface(self, deformer, frame):
        return points_of(self.path("out", "frames", f"{deformer}_surface_{frame:06d}.vtp"))

    def test_the_exported_file_moves_as_the_program_states_and_nearer_to_the_reference_than_lbs(self):
        self.assertIn("Correctives were learned from", self.baking.stdout + self.baking.stderr)
        model = Blended(self.path("out", "frames", "correctives.glb"))
        rest = self.surface("lbs", 0)
        size = numpy.linalg.norm(rest.max(axis=0) - rest.min(axis=0))
        times = sorted({float(row["time_s"]) for row in self.rows("out", "metrics.csv")})
        self.assertEqual(len(times), FRAMES)
        own, lbs, without = 0.0, 0.0, 0.0
        for frame, time_s in enumerate(times):
            moved = model.at(time_s)
            self.assertLess(abs(moved - self.surface("correctives", frame)).max(), EXACT * size, frame)
            reference = self.surface("nh_p1", frame)
            own = max(own, rms(moved, reference))
            lbs = max(lbs, rms(self.surface("lbs", frame), reference))
            model.weights[:] = 0.0
            without = max(without, rms(model.points(None, time_s), moved))
        self.assertLess(own, 0.5 * lbs)
        self.assertGreater(without, 100 * EXACT * size, "the targets change what 1e-6 would not show")

    def test_the_fitted_file_is_a_deformer_of_scenes_that_is_nearer_to_the_reference_than_lbs(self):
        facts = self.json("out", "try.json")["correctives"]
        self.assertEqual(facts["held_out"], 2)  # frames 1 and 4 of seven
        self.assertGreater(facts["trained"], 5)
        self.assertGreater(facts["seconds"], 0.0)
        measured = [facts[place] for place in ("within", "beyond") if facts[place]]
        self.assertEqual(sum(place["frames"] for place in measured), 2)
        for place in measured:
            self.assertLess(place["correctives_mm"], place["lbs_mm"])
        scene = self.read("out", "scene.toml").replace('use = ["lbs"', 'use = ["baked", "lbs"')
        scene += '[[correctives]]\nname = "baked"\nfile = "frames/correctives.toml"\n'
        self.write("out/baked.toml", scene)
        self.succeeds("run", self.path("out", "baked.toml"), "-o", self.path("run"))
        errors = {}
        with open(self.path("run", "metrics.csv"), encoding="utf-8") as table:
            for row in csv.DictReader(table):
                if row["error_l2_pct"]:
                    errors.setdefault(row["deformer"], []).append(float(row["error_l2_pct"]))
        self.assertLess(max(errors["baked"]), 0.5 * max(errors["lbs"]))

    def test_a_trial_without_it_removes_what_an_earlier_one_has_learned(self):
        """And a trial without --paraview leaves of the correctives what is of use."""
        files = lambda: sorted(os.path.basename(file)
                               for file in glob.glob(self.path("again", "frames", "correctives*")))
        self.tried("again", "--bake")
        self.assertEqual(files(), ["correctives.glb", "correctives.toml"])
        self.tried("again", "--no-reference")
        self.assertEqual(files(), [])

    def test_there_is_nothing_to_learn_from_without_a_reference(self):
        model = rig_files.write("plain", self.path("rig.glb"))
        process = program.run("try", model, "-o", self.path("none"), "--bake", "--no-reference")
        self.assertEqual(process.returncode, 2)
        self.assertFalse(os.path.exists(self.path("none")))


if __name__ == "__main__":
    unittest.main()
