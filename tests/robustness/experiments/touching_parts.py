"""Models of several parts that touch or grow together: the flesh is cut between parts that move apart, and a warning
states what could not be cut. Reference: the skinning formula of glTF."""
import csv
import unittest

import numpy

import block_rigs
import skin_formula
from trial_test import FAR_FROM_ARTIST_PCT, FRAMES, TrialTest


class TouchingParts(TrialTest):
    """Parts that nearly touch at rest and move apart: their tets are separated, so that the surface follows the
    artist's, as the skinning formula of glTF has it, within the bound of the warning."""

    def check(self, model_file, first, second, without=("--no-reference",)):
        facts, printed = self.tried(model_file, "--paraview", without=without, vertices="800")
        model, files = skin_formula.Model(model_file), self.points("frames", "lbs_surface_*.vtp")
        self.assertEqual(len(files), FRAMES)
        size = numpy.linalg.norm(numpy.ptp(model.points(None, None), axis=0))
        farthest = max(numpy.linalg.norm(points - model.points("Move", frame / (FRAMES - 1)), axis=1).max()
                       for frame, points in enumerate(files)) / size
        self.assertLess(100.0 * farthest, FAR_FROM_ARTIST_PCT)
        # The rounding in per cent of the size: the distance of two points that the file has in single precision.
        rounded_pct = FAR_FROM_ARTIST_PCT * 2 * 2.0 ** -24
        self.assertAlmostEqual(facts["from_artist"]["largest_pct"], 100.0 * farthest, delta=rounded_pct)
        self.assertRegex(printed, f"the flesh is cut between ({first} and {second}|{second} and {first})")
        self.assertIn("of the model&#x27;s size", self.read("out", "report.html"))

    def test_both_shoes_follow(self):
        self.check(block_rigs.write_shoes(self.path("shoes.glb")), "leg.L", "leg.R")

    def test_the_jaw_opens_and_no_bone_of_the_jaw_holds_the_teeth_above(self):
        """Above the mouth and in front of its corners the artist's weight of the jaw is 0, although its bone is the
        nearest one. The cut between tets of 2 cm lies at most that far from the mouth. PBS keeps these teeth, so that
        it opens more than half of the mouth."""
        self.check(block_rigs.write_mouth(self.path("mouth.glb")), "head", "jaw", without=())
        x, y, z = self.points("frames", "pbs_000000.vtu")[0].T
        above = (y > 0.08) & (z > 0.05)
        rows = csv.DictReader(self.read("out", "binding.csv").splitlines())
        bound = [row["bone"] for row, is_above in zip(rows, above, strict=True) if is_above]
        self.assertGreater(len(bound), 100)
        self.assertEqual(bound.count("jaw"), 0)
        bones = {bone["bone"]: bone
                 for bone in self.json("out", "run.json")["deformers"]["nh_p1"]["attachment"]["bones"]}
        of_head = bones["head"]["samples"] + bones["neck"]["samples"]  # springs; the two move as one
        self.assertLess(bones["jaw"]["samples"], of_head)
        model = skin_formula.Model(self.path("mouth.glb"))
        rest, found, artist = model.points(None, None), self.points("frames", "pbs_surface_*.vtp")[-1], model.points(
            "Move", 1.0)
        upper, lower = ((rest[:, 2] > 0.05) & (abs(rest[:, 1] - at) < 1e-6)
                        for at in (0.05 + block_rigs.MOUTH_GAP, 0.05))
        opening, expected = (points[upper, 1].mean() - points[lower, 1].mean() for points in (found, artist))
        self.assertGreater(opening, 0.5 * expected)

    def test_a_body_with_a_handle(self):
        """A ring has one of its own, and parts that grow together make one more."""
        self.assertNotIn("handle", self.tried(block_rigs.write_ring(self.path("ring.glb")), into="ring")[1])
        self.remarked(*self.tried(block_rigs.write_ring(self.path("open.glb"), gap=0.004)),
                      "have 1 handles and the model has 0", "note")

    def test_parts_that_cannot_be_cut_apart(self):
        """Of two shoes the right one has its bone far above. The left leg turns by 30 degrees in the last frame."""
        facts, printed = self.tried(block_rigs.write_shoes(self.path("shoes.glb"), far_bone=True))
        followed = facts["from_artist"]
        self.assertEqual([followed[name] for name in ("bone_of_flesh", "bone", "frame")],
                         ["leg.L", "leg.R", FRAMES - 1])
        # The difference of two coordinates of up to 0.15 m in single precision, [mm]
        self.assertAlmostEqual(followed["gap_mm"], 1e3 * block_rigs.SHOES_GAP, delta=1e3 * 2 * 0.15 * 2.0 ** -24)
        size_m = numpy.linalg.norm(numpy.ptp(skin_formula.Model(self.path("shoes.glb")).points(None, None), axis=0))
        self.remarked(facts, printed, "the surface that LBS carries with the tets is up to "
                                      f"{followed['largest_pct']:.1f} % of the model's size away from the artist's, "
                                      "in frame 2: there the flesh of leg.L carries the surface of leg.R, "
                                      f"with a gap of {100 * block_rigs.SHOES_GAP / size_m:.2g} % of that size")
        self.assertEqual(self.json("out", "run.json")["outcome"]["from_artist"], followed)

if __name__ == "__main__":
    unittest.main()
