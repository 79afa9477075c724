"""Numerical breakdown is an outcome: the frame and the worst element are recorded and printed, and the exit status is 3
if the run was expected to finish. Reference: the contract in experiments/command_line/README.md; the worst tet as
computed from the written frame or, where a frame was taken back, the contract in experiments/run/broken_frames.hpp."""
import unittest

import foreign_arm
import rig_files

SOLID = '[[fem]]\nname = "snh"\nmodel = "stable_neo_hookean"\nelement_order = 1\nattachment = "embedded"\n'
HARD = ("fem.0.most_newton_steps=1", "motion.frames=2", "motion.angle_deg=170.0", 'fem.0.model="neo_hookean"')
LINEAR = '[[fem]]\nname = "linear"\nmodel = "linear"\nattachment = "embedded"\n'


class Breakdown(foreign_arm.ArmTest):
    def run_scene(self, status, *overrides, fem="", use='["pbs"]'):
        """What the run printed, and the outcome on record."""
        scene = self.write("arm.toml", foreign_arm.SCENE.replace('["lbs", "dqs", "pbs"]', use) + fem)
        sets = [word for override in overrides for word in ("--set", override)]
        return self.ends(status, "run", scene, "-o", self.path("out"), *sets).stderr, self.outcome()

    def outcome(self):
        return self.json("out", "run.json")["outcome"]

    def test_positions_that_are_not_finite(self):
        printed, outcome = self.run_scene(3, "pbs.gravity_m_s2=[0.0,-1e300,0.0]", "pbs.jiggle.k_stretch=0.9")
        first = outcome["broken_frames"]["pbs"][0]
        self.assertEqual((first["what"], first["frame"]), ("not_finite", outcome["breakdowns"]["pbs"][0]))
        self.assertIn(f"numerical breakdown: pbs is not finite in frame {first['frame']}: first at vertex "
                      f"{first['first_vertex']}, {first['vertices_not_finite']} not finite", printed)
        self.assertLess(first["first_vertex"], len(self.points))

    def test_inverted_tets_of_a_nonlinear_reference(self):
        printed, outcome = self.run_scene(3, "motion.frames=2", "motion.angle_deg=170.0", 'reference.name="snh"',
                                          fem=SOLID + "contact = false\n", use='["lbs", "snh"]')
        first = outcome["broken_frames"]["snh"][0]
        self.assertEqual((first["what"], first["frame"]), ("inverted", 1))
        self.assertLess(first["volume_ratio"], 0.0)
        self.assertNotIn("numerical breakdown", printed)
        self.assertIn(f"inverted tets: snh is inverted in frame 1: worst tet {first['worst_tet']} of volume ratio",
                      printed)
        self.assertIn("; 1 of 2 frames of snh broke down", printed)
        compared = [row["error_l2_pct"] != "" for row in self.rows("out", "metrics.csv") if row["deformer"] == "lbs"]
        self.assertEqual(compared, [True, False], "the rest pose alone")

    def test_a_frame_that_newton_does_not_reach(self):
        printed, outcome = self.run_scene(3, *HARD, fem=SOLID, use='["snh"]')
        first = outcome["broken_frames"]["snh"][0]
        self.assertEqual((first["what"], first["frame"]), ("not_converged", outcome["not_converged"]["snh"][0]))
        self.assertNotIn("numerical breakdown", printed)
        self.assertIn(f"pose not reached: snh is not converged in frame {first['frame']}: "
                      f"worst tet {first['worst_tet']} of volume ratio",
                      printed)
        # The tet is that of Newton's last state: the frame itself is taken back to the last equilibrium, the rest pose.
        self.assertLess(first["volume_ratio"], 0.99)

    def test_the_bad_frames_of_each_deformer_are_counted(self):
        printed, outcome = self.run_scene(3, *HARD, "pbs.stop_residual=1e-12", "pbs.iterations=2", fem=SOLID,
                                          use='["snh", "pbs"]')
        counts = {label: len(frames) for label, frames in outcome["broken_frames"].items()}
        self.assertIn(f"; {counts['pbs']} of 2 frames of pbs, {counts['snh']} of 2 frames of snh broke down", printed)
        self.assertEqual(counts, {"pbs": 2, "snh": 1})

    def test_a_step_between_frames_that_is_not_reached(self):
        """The elbow is bent in every second step and straight in the frames, in which PBS is within its stop
        residual."""
        foreign_arm.write_bvh(self.path("arm.bvh"), [90.0 * (step % 2) for step in range(9)])
        self.write("arm.toml", foreign_arm.CLIP_SCENE % 50.0)
        self.ends(3, "run", self.scene, "-o", self.path("out"), "--set", "pbs.jiggle.k_stretch=0.5", "--set",
                  "pbs.stop_residual=0.04", says="pose not reached: pbs is not converged in frame 1 (in step 1, "
                                                 "before it): worst tet")
        first = self.outcome()["broken_frames"]["pbs"][0]
        self.assertEqual((first["what"], first["frame"], first["step"]), ("not_converged", 1, 1))
        self.assertEqual(self.outcome()["not_converged"], {"pbs": [1, 2, 3, 4]})
        self.assertEqual([row["outcome"] for row in self.rows("out", "metrics.csv")],
                         ["finished"] + 4 * ["not_converged"])

    def test_inverted_tets_of_the_linear_reference_are_on_record_and_no_failure(self):
        _, outcome = self.run_scene(0, "motion.axis=[1.0,0.0,0.0]", "motion.angle_deg=180.0", "output.frames=[4]",
                                    fem=LINEAR, use='["linear"]')  # a negative control
        last = outcome["broken_frames"]["linear"][-1]
        self.assertEqual((last["what"], last["frame"]), ("inverted", 4))
        self.ends(0, "measure", self.path("arm.msh"), self.path("out", "frames", "linear_000004.vtu"),
                  says=f"worst tet "
                  f"{last['worst_tet']} of volume ratio {last['volume_ratio']:.3g}, {last['inverted_tets']} inverted")

    def test_a_trial_whose_reference_is_not_reached(self):
        """The elbow moves 1e8 m away, so that Newton's method does not converge. All files of the trial are written
        nevertheless. Within a budget of time such a frame is left out."""
        slide = [(2, "translation", [0.0, 1.0], [[0.35, 0.0, 0.0], [1e8, 0.0, 0.0]], "LINEAR")]
        model = rig_files.write("plain", self.path("rig.glb"), animations=(), extra=[("Slide", slide)])
        command = ("try", model, "-o", self.path("out"), "--frames", "2", "--vertices", "300", "--reference-seconds")
        self.ends(0, *command, "3", says="the reference did not reach 1 of 2 frames, which have no errors")
        self.assertEqual([frame["frame"] for frame in self.outcome()["reference_frames"]["not_reached"]], [1])
        self.ends(3, *command, "0", says="pose not reached: nh_p1 is not converged in frame 1: worst tet")
        self.assertEqual(self.outcome()["not_converged"], {"nh_p1": [1]})
        self.assertTrue(self.json("out", "try.json")["summary"])
        for name in ("scene.toml", "report.html"):
            self.assertTrue(self.read("out", name), name)

    def test_a_reference_that_passes_through_itself_is_a_warning_and_one_with_contact_does_not(self):
        for contact, frames in (("true", 0), ("false", 2)):
            sets = ('deformers.use=["lbs", "nh_p1"]', "character.vertices=600", "motion.frames=6",
                    "output.frames_every=0", f"fem.3.contact={contact}")
            printed = self.succeeds("run", "limb_bend", "-o", self.path("out"),
                                    *(word for one in sets for word in ("--set", one))).stderr
            # The forearm is bent by up to 150 degrees, in steps of 30.
            self.assertEqual(self.outcome()["frames_with_overlap"], frames)
            words = f"limb_bend.toml: the reference passes through itself in {frames} of 6 frames, first in frame 4"
            self.assertEqual([warning.startswith(words) for warning in self.outcome()["warnings"]],
                             [True] * bool(frames))
            self.assertEqual(f"pbskin: warning: {words}" in printed, frames > 0)

    def test_flesh_that_lags_behind_its_bone_is_a_warning(self):
        """Springs of a thousandth of the stiffness turn the forearm's flesh less. It lags behind by less than the angle
        of the bend, and most in the last frame."""
        turns = []
        for factor in (10, 0.01):
            sets = ('deformers.use=["lbs", "nh_p1"]', "character.vertices=300", "motion.frames=4",
                    "output.frames_every=0", f"fem.3.spring_factor={factor}", "fem.3.core_radius=0.2")
            printed = self.succeeds("run", "limb_bend", "-o", self.path("out"),
                                    *(word for one in sets for word in ("--set", one))).stderr
            lag, lags = self.outcome()["reference_lag"], factor < 1
            turns.append(lag["largest_turn_deg"])
            self.assertEqual("forearm alone moves is turned by up to" in printed, lags, printed)
            self.assertEqual(sum("forearm alone moves is turned by up to" in warning
                                 for warning in self.outcome()["warnings"]), lags)
            if lags:
                self.assertEqual((lag["bone"], lag["frame"]), ("forearm", 3))
                self.assertIn(f"the flesh that forearm alone moves is turned by up to {turns[1]:.0f} degrees against "
                              "it, in frame 3",
                              printed)
        self.assertLess(turns[0], turns[1])
        self.assertLess(turns[1], 150)

    def test_a_run_that_holds_names_nothing(self):
        _, outcome = self.run_scene(0, use='["lbs", "pbs"]')
        self.assertEqual(outcome["broken_frames"], {})


if __name__ == "__main__":
    unittest.main()
