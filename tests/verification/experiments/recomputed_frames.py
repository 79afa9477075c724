"""metrics.csv compared with volumes and inverted tets recomputed from the written frames by another program (VTK's reader and numpy), on a
tet mesh and skeleton that are not from the project. Reference: the definitions of the metrics. Tolerance: the contract's 1e-6 percentage
points."""
import unittest

import numpy
from vtk.util.numpy_support import vtk_to_numpy

import foreign_arm
import written_frames
from written_frames import signed_volumes

TOLERANCE_PCT = 1e-6


def longest_edge(grid):
    corners = written_frames.points(grid)[written_frames.tets(grid)]
    return numpy.linalg.norm(corners[:, :, None] - corners[:, None, :], axis=3).max()


def ratio_rounding(grid, rest):
    """The rounding error of a volume over that at rest, on both sides. Six volumes are a sum of products of three edges, whose magnitudes
    add up to at most 3 sqrt(3) longest edges cubed; a product goes through ten roundings, and the quotient is one more."""
    least = signed_volumes(rest).min()

    def of_volume(body):
        return 10 * numpy.finfo(float).eps / 2 * 3 ** 1.5 * longest_edge(body) ** 3 / 6.0

    largest_ratio = numpy.abs(signed_volumes(grid)).max() / least
    return 2 * (of_volume(grid) + largest_ratio * of_volume(rest)) / least + numpy.finfo(float).eps * largest_ratio


class RecomputedFrames(foreign_arm.ArmTest):
    cells = (20, 4, 4)

    def setUp(self):
        super().setUp()
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.metrics = self.rows("out", "metrics.csv")

    def frame(self, row):
        return written_frames.read(self.path("out", "frames", "%s_%06d.vtu" % (row["deformer"], int(row["frame"]))))

    def test_volumes_and_inverted_tets(self):
        self.assertEqual(len(self.metrics), 15)
        rest = signed_volumes(self.frame(self.metrics[0]))
        for row in self.metrics:
            volumes = signed_volumes(self.frame(row))
            signed = 100.0 * (volumes.sum() - rest.sum()) / rest.sum()
            absolute = 100.0 * numpy.abs(volumes - rest).sum() / rest.sum()
            self.assertAlmostEqual(float(row["volume_change_pct"]), signed, delta=TOLERANCE_PCT)
            self.assertAlmostEqual(float(row["volume_abs_change_pct"]), absolute, delta=TOLERANCE_PCT)
            self.assertEqual(int(row["inverted_tets"]), int((volumes <= 0.0).sum()))
        self.assertGreater(max(abs(float(row["volume_change_pct"])) for row in self.metrics), 1.0)

    def test_fields_of_the_frames(self):
        rest = written_frames.points(self.frame(self.metrics[0]))
        rest_volumes = signed_volumes(self.frame(self.metrics[0]))
        for row in self.metrics:
            grid = self.frame(row)
            points = written_frames.points(grid)
            self.assertEqual(points.dtype, numpy.float64)
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("rest_position")), rest)
            # One subtraction of the same numbers, rounded to nearest on both sides.
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("displacement")), points - rest)
            ratio = signed_volumes(grid) / rest_volumes
            numpy.testing.assert_allclose(vtk_to_numpy(grid.GetCellData().GetArray("volume_ratio")), ratio, rtol=0,
                                          atol=ratio_rounding(grid, self.frame(self.metrics[0])))

    def test_measure_says_the_same_as_run(self):
        rows = [row for row in self.metrics if row["deformer"] == "pbs"]
        frames = [self.path("out", "frames", "pbs_%06d.vtu" % int(row["frame"])) for row in rows]
        self.succeeds("measure", self.path("arm.msh"), *frames, "--csv", self.path("measured.csv"))
        for row, measured in zip(rows, self.rows("measured.csv"), strict=True):
            for column in ("volume_change_pct", "volume_abs_change_pct", "j_min", "stretch_rms"):
                self.assertAlmostEqual(float(row[column]), float(measured[column]), delta=TOLERANCE_PCT)
            self.assertEqual(row["inverted_tets"], measured["inverted_tets"])

    def test_runs_repeat_to_the_bit(self):
        self.succeeds("run", self.scene, "-o", self.path("again"))
        hashes = [self.json(folder, "run.json")["state_hash"] for folder in ("out", "again")]
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(sorted(hashes[0]), ["dqs", "lbs", "pbs"])


if __name__ == "__main__":
    unittest.main()
