"""Frames of a run compared with those that other code computes, on a tet mesh and skeleton that are not from the
project.

RecomputedFrames: metrics.csv compared with volumes and inverted tets recomputed from the written frames by VTK's reader
and numpy. Reference: the definitions of the metrics. Tolerance: the contract's 1e-6 percentage points.

PlainIterations: order `plain` in double precision compared with position based dynamics written a second time, in
numpy, from the published formulas. Reference: M. Mueller et al., Position based dynamics, VRIPHYS 2006 (distance
constraint, Eq. 8-11; volume of a tet; corrections dp_i = -w_i grad_i C / sum w |grad C|^2, times k) and the paper's
Sec. 3.6 (the distance of a vertex from its point on the nearest bone), in Algorithm 1's order: all binds, all edges,
all tets, 24 times. File order: vertices, edges sorted by their vertices, tets as in the file. Only the initial state is
the program's: the LBS positions of the same frame. Tolerance: both compute in double precision. A vertex is moved by
its bind, edges and tets, each a sum of at most `ROUNDINGS` rounded terms that are no larger than the body. The growth
of a rounding in later projections is measured: initial positions that differ by 1e-9 m.

ReferenceErrorBar: the reference's error bar compared with a real error. Reference: a better solution of the same
problem, order 2 on refined tets, from another run of the program; distances are recomputed with numpy from the written
frames. A bar must cover the distance of the reference to it, and be no larger than the largest difference of the
compared solutions times the largest factor that the method can apply."""
import itertools
import unittest

from vtk.util.numpy_support import vtk_to_numpy
import numpy

import foreign_arm
import program
import written_frames
from written_frames import signed_volumes

TOLERANCE_PCT = 1e-6


def ratio_rounding(grid, rest):
    """The rounding error of a volume over that at rest, on both sides. Six volumes are a sum of products of three
    edges, whose magnitudes add up to at most 3 sqrt(3) longest edges cubed; a product goes through ten roundings, and
    the quotient is one more."""
    least = signed_volumes(rest).min()

    def of_volume(body):
        corners = written_frames.points(body)[written_frames.tets(body)]
        longest_edge = numpy.linalg.norm(corners[:, :, None] - corners[:, None, :], axis=3).max()
        return 10 * numpy.finfo(float).eps / 2 * 3 ** 1.5 * longest_edge ** 3 / 6.0

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


ITERATIONS, ANGLE_DEG = 24, 120.0
K_STRETCH, K_VOLUME, K_BIND = 0.2, 1.0, 1.0
ROUNDINGS = 60  # a volume, its four gradients and their squares, the quotient and the correction
SCENE = foreign_arm.SCENE.replace("frames = 5", "frames = 2").replace('use = ["lbs", "dqs", "pbs"]',
                                                                      'use = ["lbs", "pbs"]')
SHOULDER, ELBOW, HAND = (numpy.array([x, 0.0, 0.0]) for x in (0.0, 0.5, 1.0))


def nearest_on_bone(point, head, tail):
    along = numpy.dot(point - head, tail - head) / numpy.dot(tail - head, tail - head)
    return head + min(max(along, 0.0), 1.0) * (tail - head)


def volume(p):
    return numpy.dot(numpy.cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6.0


class Body:
    """The constraints at rest, and the posed points of the bones."""

    def __init__(self, rest, tets):
        self.tets = tets
        self.edges = sorted({tuple(sorted(pair)) for tet in tets for pair in itertools.combinations(tet, 2)})
        self.lengths = [numpy.linalg.norm(rest[i] - rest[j]) for i, j in self.edges]
        self.volumes = [volume(rest[list(tet)]) for tet in tets]
        angle = numpy.radians(ANGLE_DEG)
        turn = numpy.array([[numpy.cos(angle), -numpy.sin(angle), 0.0], [numpy.sin(angle), numpy.cos(angle), 0.0],
                            [0.0, 0.0, 1.0]])
        self.distances, self.bind_points = [], []
        for point in rest:
            on_bones = nearest_on_bone(point, SHOULDER, ELBOW), nearest_on_bone(point, ELBOW, HAND)
            distances = [numpy.linalg.norm(point - on_bone) for on_bone in on_bones]
            nearest = int(distances[1] < distances[0])
            self.distances.append(distances[nearest])
            self.bind_points.append(ELBOW + turn @ (on_bones[1] - ELBOW) if nearest else on_bones[0])

    def project_binds(self, p):
        for i, (q, distance) in enumerate(zip(self.bind_points, self.distances, strict=True)):
            length = numpy.linalg.norm(p[i] - q)
            if length > 0.0:
                p[i] -= K_BIND * (length - distance) * (p[i] - q) / length

    def project_edges(self, p):
        for (i, j), rest_length in zip(self.edges, self.lengths, strict=True):
            length = numpy.linalg.norm(p[i] - p[j])
            correction = K_STRETCH * 0.5 * (length - rest_length) * (p[i] - p[j]) / length
            p[i] -= correction
            p[j] += correction

    def project_tets(self, p, tets):
        for t in tets:
            corners = list(self.tets[t])
            a, b, c, d = p[corners]
            gradients = numpy.array([numpy.zeros(3), numpy.cross(c - a, d - a), numpy.cross(d - a, b - a),
                                     numpy.cross(b - a, c - a)]) / 6.0
            gradients[0] = -gradients.sum(axis=0)
            p[corners] -= K_VOLUME * (volume(p[corners]) - self.volumes[t]) / (gradients ** 2).sum() * gradients

    def iterated(self, start, last_tet_first=False):
        p, tets = start.copy(), range(len(self.tets))
        for _ in range(ITERATIONS):
            self.project_binds(p)
            self.project_edges(p)
            self.project_tets(p, reversed(tets) if last_tet_first else tets)
        return p

    def most_projections(self, vertices):
        """The largest number of constraints at a vertex."""
        counts = numpy.ones(vertices)
        for constraint in [*self.edges, *self.tets]:
            counts[list(constraint)] += 1
        return counts.max()


class PlainIterations(foreign_arm.ArmTest):
    scene_text = SCENE

    def setUp(self):
        super().setUp()
        settings = ("pbs.order=plain", "pbs.precision=f64", f"pbs.iterations={ITERATIONS}")
        self.succeeds("run", self.scene, "-o", self.path("out"), *(word for one in settings for word in ("--set", one)))
        rest = self.frame("lbs", 0)
        self.rest = self.positions(rest)
        self.tets = [tuple(map(int, tet)) for tet in written_frames.tets(rest)]
        self.body = Body(self.rest, self.tets)
        self.start = self.positions(self.frame("lbs", 1))
        self.found = self.positions(self.frame("pbs", 1))

    def frame(self, deformer, number):
        return written_frames.read(self.path("out", "frames", f"{deformer}_{number:06d}.vtu"))

    def positions(self, grid):
        return written_frames.points(grid).astype(numpy.float64)

    def tolerance_m(self, expected):
        change = 1e-9 * numpy.random.default_rng(1).uniform(-1.0, 1.0, self.start.shape)
        growth = max(1.0, numpy.abs(self.body.iterated(self.start + change) - expected).max() / numpy.abs(change).max())
        rounding_m = numpy.finfo(float).eps / 2 * ROUNDINGS * numpy.abs(self.rest).max()
        return ITERATIONS * self.body.most_projections(len(self.rest)) * rounding_m * growth

    def test_24_iterations_in_file_order(self):
        expected = self.body.iterated(self.start)
        tolerance_m = self.tolerance_m(expected)
        self.assertLess(tolerance_m, 1e-8)
        self.assertGreater(numpy.abs(expected - self.start).max(), 1e-2)
        self.assertLess(numpy.abs(self.found - expected).max(), tolerance_m)
        # Another order of the tets is not within it.
        self.assertGreater(numpy.abs(self.found - self.body.iterated(self.start, last_tet_first=True)).max(),
                           1e3 * tolerance_m)


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


# The difference from the finest solution, and 3 / (2^p - 1) times another one, where p is at least 0.5.
LARGEST_FACTOR = 1.0 + 3.0 / (2.0 ** 0.5 - 1.0)


@unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
class ReferenceErrorBar(foreign_arm.ArmTest):
    scene_text = foreign_arm.SCENE + SMALL_ANGLE

    def run_scene(self, name, *settings):
        arguments = ["motion.angle_deg=5", "motion.frames=2", *settings]
        self.succeeds("run", self.scene, "-o", self.path(name), "--quiet",
                      *[part for text in arguments for part in ("--set", text)])
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
            name = deformer + "_bar"
            rows, record = self.run_scene(name, 'deformers.use=["%s", "lbs"]' % deformer, "reference.name=" + deformer,
                                          "reference.error_bar=both")
            found, rest = written_frames.points(self.frame(name, deformer)), self.frame(name, deformer, 0)
            mass = lumped_volumes(rest)
            diagonal = numpy.linalg.norm(numpy.ptp(written_frames.points(rest), axis=0))

            def distances(one, other):
                squares = ((one[:len(mass)] - other[:len(mass)]) ** 2).sum(axis=1)
                return {"reference_error_l2_pct": 100.0 * numpy.sqrt((mass * squares).sum() / mass.sum()) / diagonal,
                        "reference_error_linf_m": numpy.sqrt(squares.max())}

            of = record["reference_error_method"]["solutions"]
            compared = [solutions[solution["element_order"], solution["refinements"]] for solution in of]
            for column, error in distances(found, better).items():
                bound = float(rows[deformer][column])
                largest = max(distances(one, other)[column] for one, other in itertools.combinations(compared, 2))
                self.assertGreater(bound, error, name + " " + column)
                # The rounding of a sum of one sign and some twenty operations, on both sides.
                rounding = (len(mass) + 20) * numpy.finfo(float).eps
                self.assertLess(bound, (1.0 + rounding) * LARGEST_FACTOR * largest, name + " " + column)
                self.assertEqual(bound, float(rows["lbs"][column]))  # a value of the frame, the same in every row
            self.assertEqual(rows[deformer]["error_below_reference_error"], "")
            self.assertEqual(len(compared), 4)

    def test_skin_metrics_of_a_run_without_an_error_bar(self):
        rows, record = self.run_scene("skin", 'deformers.use=["p1", "lbs"]', "reference.name=p1")
        self.assertNotIn("reference_error_l2_pct", rows["p1"])  # without an error bar the records are as they were
        self.assertNotIn("reference_error_method", record)
        rest, frames = self.frame("skin", "lbs", 0), [self.frame("skin", name) for name in ("lbs", "p1")]
        tets, points = written_frames.tets(rest), written_frames.points(rest)
        faces = numpy.concatenate([tets[:, [1, 2, 3]], tets[:, [0, 3, 2]], tets[:, [0, 1, 3]], tets[:, [0, 2, 1]]])
        _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        skin = faces[first[count == 1]]

        def normals(of):
            return numpy.cross(of[skin[:, 1]] - of[skin[:, 0]], of[skin[:, 2]] - of[skin[:, 0]])

        areas, weights = numpy.linalg.norm(normals(points), axis=1) / 2.0, numpy.zeros(len(points))
        for corner in range(3):
            numpy.add.at(weights, skin[:, corner], areas / 3.0)
        size = numpy.ptp(points[weights > 0.0], axis=0)
        lbs, reference = (written_frames.points(frame)[:len(points)] for frame in frames)
        apart = numpy.linalg.norm(lbs - reference, axis=1)
        rms = numpy.sqrt((weights * apart ** 2).sum() / weights.sum())
        one, other = normals(lbs), normals(reference)
        turned = numpy.degrees(numpy.arctan2(numpy.linalg.norm(numpy.cross(one, other), axis=1),
                                             (one * other).sum(axis=1)))
        to_mm = 1700.0 / size.max()
        for column, expected in (("skin_rms_mm", to_mm * rms), ("skin_largest_mm", to_mm * apart[weights > 0.0].max()),
                                 ("skin_rms_pct", 100.0 * rms / numpy.linalg.norm(size)),
                                 ("normals_mean_deg", (areas * turned).sum() / areas.sum())):
            found = float(rows["lbs"][column])
            self.assertGreater(found, 0.0)
            # Positions of a few metres are rounded, and distances and heights of triangles are above 1e-4 of them.
            self.assertAlmostEqual(found, expected, delta=1e-9 * expected, msg=column)
        for column, values, of in (("skin_p95_mm", to_mm * apart, weights), ("normals_p95_deg", turned, areas)):
            share = of[values <= float(rows["lbs"][column]) * (1.0 + 1e-9)].sum() / of.sum()
            self.assertTrue(0.95 - 1e-12 <= share < 0.95 + of.max() / of.sum() + 1e-12, column)


if __name__ == "__main__":
    unittest.main()
