"""Numerical breakdown is an outcome: the frame and the worst element are recorded and printed, and the exit status is 3 if the run was
expected to finish. Reference: the contract in experiments/command_line/README.md; the worst tet as computed from the written frame or,
where a frame was taken back, the contract in experiments/run/frame_measurement.hpp."""
import csv
import json
import unittest

import foreign_arm
import program
import rig_files

SOLID = '[[fem]]\nname = "snh"\nmodel = "stable_neo_hookean"\nelement_order = 1\nattachment = "embedded"\n'
LINEAR = '[[fem]]\nname = "linear"\nmodel = "linear"\nattachment = "embedded"\n'


def volume(points, tet):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = ([points[tet[k]][i] - points[tet[0]][i] for i in range(3)] for k in (1, 2, 3))
    return ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)


class Breakdown(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.points, self.tets = foreign_arm.mesh((10, 2, 2))
        foreign_arm.write_msh(self.path("arm.msh"), self.points, self.tets)
        self.write("arm.skeleton.toml", foreign_arm.SKELETON)

    def run_scene(self, *overrides, fem="", use='["pbs"]'):
        scene = self.write("arm.toml", foreign_arm.SCENE.replace('["lbs", "dqs", "pbs"]', use) + fem)
        sets = [word for override in overrides for word in ("--set", override)]
        return program.run("run", scene, "-o", self.path("out"), *sets)

    def outcome(self):
        return json.loads(self.read("out", "run.json"))["outcome"]

    def test_positions_that_are_not_finite(self):
        process = self.run_scene("pbs.gravity_m_s2=[0.0,-1e300,0.0]", "pbs.jiggle.k_stretch=0.9")
        self.assertEqual(process.returncode, 3, process.stderr)
        first = self.outcome()["broken_frames"]["pbs"][0]
        self.assertEqual((first["what"], first["frame"]), ("not_finite", self.outcome()["breakdowns"]["pbs"][0]))
        self.assertIn(f"numerical breakdown: pbs is not finite in frame {first['frame']}: first at vertex {first['first_vertex']}, "
                      f"{first['vertices_not_finite']} not finite", process.stderr)
        self.assertLess(first["first_vertex"], len(self.points))

    def test_inverted_tets_of_a_nonlinear_reference(self):
        process = self.run_scene("motion.frames=2", "motion.angle_deg=170.0", fem=SOLID, use='["snh"]')
        self.assertEqual(process.returncode, 3, process.stderr)
        first = self.outcome()["broken_frames"]["snh"][0]
        self.assertEqual((first["what"], first["frame"]), ("inverted", 1))
        self.assertLess(first["volume_ratio"], 0.0)
        self.assertNotIn("numerical breakdown", process.stderr)
        self.assertIn(f"inverted tets: snh is inverted in frame 1: worst tet {first['worst_tet']} of volume ratio", process.stderr)
        self.assertIn("; 1 of 2 frames of snh broke down", process.stderr)

    def test_a_frame_that_newton_does_not_reach(self):
        process = self.run_scene("fem.0.most_newton_steps=1", "motion.frames=2", "motion.angle_deg=170.0", 'fem.0.model="neo_hookean"',
                                 fem=SOLID, use='["snh"]')
        self.assertEqual(process.returncode, 3, process.stderr)
        outcome = self.outcome()
        first = outcome["broken_frames"]["snh"][0]
        self.assertEqual((first["what"], first["frame"]), ("not_converged", outcome["not_converged"]["snh"][0]))
        self.assertNotIn("numerical breakdown", process.stderr)
        self.assertIn(f"pose not reached: snh is not converged in frame {first['frame']}: worst tet {first['worst_tet']} of volume ratio",
                      process.stderr)
        # The tet is that of Newton's last state: the frame itself is taken back to the last equilibrium, the rest pose.
        self.assertLess(first["volume_ratio"], 0.99)

    def test_the_bad_frames_of_each_deformer_are_counted(self):
        process = self.run_scene("fem.0.most_newton_steps=1", "motion.frames=2", "motion.angle_deg=170.0", 'fem.0.model="neo_hookean"',
                                 "pbs.stop_residual=1e-12", "pbs.iterations=2", fem=SOLID, use='["snh", "pbs"]')
        self.assertEqual(process.returncode, 3, process.stderr)
        counts = {label: len(frames) for label, frames in self.outcome()["broken_frames"].items()}
        self.assertIn(f"; {counts['pbs']} of 2 frames of pbs, {counts['snh']} of 2 frames of snh broke down", process.stderr)
        self.assertEqual(counts, {"pbs": 2, "snh": 1})

    def test_pbs_above_its_stop_residual(self):
        process = self.run_scene("pbs.stop_residual=1e-12", "pbs.iterations=2")
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertIn("pose not reached: pbs is not converged in frame 0: worst tet", process.stderr)

    def test_a_step_between_frames_that_is_not_reached(self):
        """The elbow is bent in every second step and straight in the frames, in which PBS is within its stop residual."""
        foreign_arm.write_bvh(self.path("arm.bvh"), [90.0 * (step % 2) for step in range(9)])
        self.write("arm.toml", foreign_arm.CLIP_SCENE % 50.0)
        process = program.run("run", self.path("arm.toml"), "-o", self.path("out"), "--set", "pbs.jiggle.k_stretch=0.5",
                              "--set", "pbs.stop_residual=0.04")
        self.assertEqual(process.returncode, 3, process.stderr)
        first = self.outcome()["broken_frames"]["pbs"][0]
        self.assertEqual((first["what"], first["frame"], first["step"]), ("not_converged", 1, 1))
        self.assertEqual(self.outcome()["not_converged"], {"pbs": [1, 2, 3, 4]})
        self.assertIn("pose not reached: pbs is not converged in frame 1 (in step 1, before it): worst tet", process.stderr)
        with open(self.path("out", "metrics.csv"), encoding="utf-8", newline="") as file:
            self.assertEqual([row["outcome"] for row in csv.DictReader(file)], ["finished"] + 4 * ["not_converged"])

    def test_inverted_tets_of_the_linear_reference_are_on_record_and_no_failure(self):
        process = self.run_scene("motion.axis=[1.0,0.0,0.0]", "motion.angle_deg=180.0", "output.frames=[4]", fem=LINEAR, use='["linear"]')
        self.assertEqual(process.returncode, 0, process.stderr)  # a negative control
        last = self.outcome()["broken_frames"]["linear"][-1]
        self.assertEqual((last["what"], last["frame"]), ("inverted", 4))
        process = program.run("measure", self.path("arm.msh"), self.path("out", "frames", "linear_000004.vtu"))
        self.assertIn(f"worst tet {last['worst_tet']} of volume ratio {last['volume_ratio']:.3g}, {last['inverted_tets']} inverted",
                      process.stderr)

    def test_a_trial_whose_reference_is_not_reached(self):
        """The elbow moves 1e8 m away, so that Newton's method does not converge. All files of the trial are written nevertheless."""
        slide = [(2, "translation", [0.0, 1.0], [[0.35, 0.0, 0.0], [1e8, 0.0, 0.0]], "LINEAR")]
        with open(self.path("far.glb"), "wb") as file:
            file.write(rig_files.rig(**{**rig_files.VARIANTS["plain"], "animations": (), "extra": [("Slide", slide)]}))
        process = program.run("try", self.path("far.glb"), "-o", self.path("out"), "--frames", "3", "--vertices", "300")
        self.assertEqual(process.returncode, 3, process.stderr)
        self.assertEqual(self.outcome()["not_converged"], {"nh_p1": [1, 2]})
        self.assertIn("pose not reached: nh_p1 is not converged in frame 1: worst tet", process.stderr)
        self.assertTrue(json.loads(self.read("out", "try.json"))["summary"])
        for name in ("scene.toml", "report.html"):
            self.assertTrue(self.read("out", name), name)

    def test_a_run_that_holds_names_nothing(self):
        self.assertEqual(self.run_scene(use='["lbs", "pbs"]').returncode, 0)
        self.assertEqual(self.outcome()["broken_frames"], {})

    def test_measure_names_the_worst_tet(self):
        points = [list(point) for point in self.points]
        vertex = self.tets[7][3]
        points[vertex] = [10.0, 10.0, 10.0]
        foreign_arm.write_msh(self.path("torn.msh"), points, self.tets)
        ratios = [volume(points, tet) / volume(self.points, tet) for tet in self.tets]
        process = program.run("measure", self.path("arm.msh"), self.path("torn.msh"))
        self.assertEqual(process.returncode, 0)
        self.assertIn(f"worst tet {ratios.index(min(ratios))} of volume ratio {min(ratios):.3g}, {sum(r <= 0 for r in ratios)} inverted",
                      process.stderr)

    def test_measure_refuses_a_frame_that_is_not_finite_and_names_the_vertex(self):
        points = [list(point) for point in self.points]
        points[17][1] = float("nan")
        points[20][0] = float("inf")
        foreign_arm.write_msh(self.path("broken.msh"), points, self.tets)
        process = program.run("measure", self.path("arm.msh"), self.path("broken.msh"))
        self.assertEqual(process.returncode, 2, process.stdout)
        self.assertRegex(process.stderr, r"broken\.msh: vertex 17 = .*nan.*: expected finite coordinates")


if __name__ == "__main__":
    unittest.main()
