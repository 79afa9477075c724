"""The reference's error bar compared with a real error. Reference: a better solution of the same problem, order 2 on refined tets, from
another run of the program; distances are recomputed with numpy from the written frames. A bar must cover the distance of the reference to
it, and be no larger than the largest difference of the compared solutions times the largest factor that the method can apply."""
import itertools
import unittest

import numpy

import foreign_arm
import written_frames

SMALL_ANGLE = """
[[fem]]
name = "p1"
element_order = 1
[[fem]]
name = "p2"
element_order = 2
"""


def lumped_volumes(rest):
    tets, lumped = written_frames.tets(rest), numpy.zeros(rest.GetNumberOfPoints())
    for corner in range(4):
        numpy.add.at(lumped, tets[:, corner], written_frames.signed_volumes(rest) / 4.0)
    return lumped


def largest_factor(method):
    """Two solutions with the ratio r of their mesh sizes and the presumed order p: 3 r^p / (r^p - 1), for the coarser one. Four: the
    difference from the finest solution, and 3 / (2^p - 1) times another one, where p is at least 0.5."""
    sizes = numpy.cumprod([1.0, *method["ratios"]])
    if len(sizes) == 2:
        growth = sizes[1] ** method["order"]
        return 3.0 * growth / (growth - 1.0)
    return 1.0 + 3.0 / (2.0 ** 0.5 - 1.0)


class ReferenceErrorBar(foreign_arm.ArmTest):
    scene_text = foreign_arm.SCENE + SMALL_ANGLE

    def run_scene(self, name, *settings):
        arguments = ["motion.angle_deg=5", "motion.frames=2", *settings]
        self.succeeds("run", self.scene, "-o", self.path(name), "--quiet", *[part for text in arguments for part in ("--set", text)])
        rows = {row["deformer"]: row for row in self.rows(name, "metrics.csv") if row["frame"] == "1"}
        return rows, self.json(name, "run.json")

    def frame(self, name, deformer, number=1):
        return written_frames.read(self.path(name, "frames", "%s_%06d.vtu" % (deformer, number)))

    def test_covers_the_distance_to_a_better_solution(self):
        solutions = {}
        for refine in (0, 1):
            name = "refined_%d" % refine
            self.run_scene(name, 'deformers.use=["p1", "p2"]', "character.refine=%d" % refine)
            for order in (1, 2):
                solutions[order, refine] = written_frames.points(self.frame(name, "p%d" % order))
        better = solutions[2, 1]
        for deformer in ("p1", "p2"):
            for bar in ("orders", "refined", "both"):
                name = deformer + "_" + bar
                rows, record = self.run_scene(name, 'deformers.use=["%s", "lbs"]' % deformer, "reference.name=" + deformer,
                                              "reference.error_bar=" + bar)
                found, rest = written_frames.points(self.frame(name, deformer)), self.frame(name, deformer, 0)
                mass = lumped_volumes(rest)
                diagonal = numpy.linalg.norm(numpy.ptp(written_frames.points(rest), axis=0))

                def distances(one, other):
                    squares = ((one[:len(mass)] - other[:len(mass)]) ** 2).sum(axis=1)
                    return {"reference_error_l2_pct": 100.0 * numpy.sqrt((mass * squares).sum() / mass.sum()) / diagonal,
                            "reference_error_linf_m": numpy.sqrt(squares.max())}

                method = record["reference_error_method"]
                compared = [solutions[solution["element_order"], solution["refinements"]] for solution in method["solutions"]]
                for column, error in distances(found, better).items():
                    bound = float(rows[deformer][column])
                    largest = max(distances(one, other)[column] for one, other in itertools.combinations(compared, 2))
                    self.assertGreater(bound, error, name + " " + column)
                    rounding = (len(mass) + 20) * numpy.finfo(float).eps  # of a sum of one sign and some twenty operations, on both sides
                    self.assertLess(bound, (1.0 + rounding) * largest_factor(method) * largest, name + " " + column)
                    self.assertEqual(bound, float(rows["lbs"][column]))  # a value of the frame, the same in every row
                self.assertEqual(rows[deformer]["error_below_reference_error"], "")
                self.assertEqual(len(compared), 4 if bar == "both" else 2)

    def test_leaves_the_records_as_they_were_without_it(self):
        rows, record = self.run_scene("none", 'deformers.use=["p1", "lbs"]', "reference.name=p1")
        self.assertNotIn("reference_error_l2_pct", rows["p1"])
        self.assertNotIn("reference_error_method", record)


if __name__ == "__main__":
    unittest.main()
