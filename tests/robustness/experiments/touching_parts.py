"""Parts that nearly touch at rest and move apart: their tets are separated, so that the surface follows the artist's within 2 % of the
model's size, which is the bound of the warning. Reference: the skinning formula of glTF, computed by skin_formula.py."""
import glob
import unittest

import numpy

import block_rigs
import program
import skin_formula
from written_frames import points_of

FRAMES = 3
BOUND = 0.02


class TouchingParts(program.ProgramTest):
    def farthest(self, model_file):
        """How far the surface that LBS carries is from the formula's, over the size of the model; try.json; what was printed."""
        process = self.succeeds("try", model_file, "-o", self.path("out"), "--no-reference", "--frames", FRAMES, "--paraview")
        model, farthest = skin_formula.Model(model_file), 0.0
        for frame, file in enumerate(sorted(glob.glob(self.path("out", "frames", "lbs_surface_*.vtp")))):
            expected = model.points("Move", frame / (FRAMES - 1))
            size = numpy.linalg.norm(numpy.ptp(model.points(None, None), axis=0))
            farthest = max(farthest, numpy.linalg.norm(points_of(file) - expected, axis=1).max() / size)
        return farthest, self.json("out", "try.json"), process.stderr

    def check(self, model_file, first, second):
        farthest, facts, printed = self.farthest(model_file)
        self.assertLess(farthest, BOUND)
        self.assertAlmostEqual(facts["from_artist"]["largest_pct"], 100.0 * farthest, delta=1e-3)  # single precision
        self.assertRegex(printed, f"the flesh is cut between ({first} and {second}|{second} and {first})")
        self.assertIn("of the model&#x27;s size", self.read("out", "report.html"))

    def test_both_shoes_follow(self):
        self.check(block_rigs.write_shoes(self.path("shoes.glb")), "leg.L", "leg.R")

    def test_the_jaw_opens(self):
        self.check(block_rigs.write_mouth(self.path("mouth.glb")), "head", "jaw")


if __name__ == "__main__":
    unittest.main()
