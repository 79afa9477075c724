"""A broken solver changes the verdict: C02 is judged from records of the twisted and the bent limb, by the correct solver and by broken
ones. Reference: the paper's bound of 0.5 % and geometry. Blending folds the sections of a twist and the crease of a bend. If the volume
constraints are dropped, their gradient has the wrong sign or nothing is projected, the volume therefore holds at fewer angles."""
import json
import pathlib
import unittest

import program


DROPPED = ("--set", "pbs.k_volume=0.0")
SIGN = ("--set", "pbs.variant.volume_form=sign", "--set", "pbs.order=plain")
NOTHING = DROPPED + ("--set", "pbs.k_stretch=0.0", "--set", "pbs.k_bind=0.0")


class BrokenSolver(program.ProgramTest):
    def verdict(self, scene, name, *overrides):
        """The verdict, and the angle up to which C02 holds."""
        results = pathlib.Path(self.path(name))
        self.succeeds("run", scene, "-o", results / "volume" / scene, "--quiet", "--set", "motion.frames=10", "--set",
                      "output.frames_every=0", "--set", "reference.name=", "--set", 'deformers.use=["lbs", "pbs"]', "--set",
                      "character.vertices=600", *overrides)
        plan = {"schema": 1, "runs": [{"name": scene, "scene": scene, "cost_s": 1.0}], "left_out": []}
        (results / "volume" / "plan.json").write_text(json.dumps(plan))
        self.succeeds("reproduce", "C02", "--judge", "-o", results, "--quiet")
        claims = {claim["id"]: claim for claim in json.loads((results / "claims.json").read_text())["claims"]}
        case = [case for case in claims["C02"]["cases"] if case["quantity"] == "volume_change_pct"][0]
        return claims["C02"]["verdict"], case["held_angles_deg"][0][1] if case["held_angles_deg"] else 0.0

    def holds_at_fewer_angles(self, scene, name, overrides):
        _, whole_deg = self.verdict(scene, scene + "_as_it_is")
        kind, held_deg = self.verdict(scene, scene + name, *overrides)
        self.assertLess(held_deg, whole_deg, scene + name)
        return kind

    def test_volume_constraints_dropped(self):
        self.holds_at_fewer_angles("limb_twist", "_dropped", DROPPED)
        self.assertEqual(self.holds_at_fewer_angles("limb_bend", "_dropped", DROPPED), "not_reproduced")

    def test_sign_of_the_volume_gradient_turned_round(self):
        for scene in ("limb_twist", "limb_bend"):
            self.assertEqual(self.holds_at_fewer_angles(scene, "_sign", SIGN), "not_reproduced")

    def test_nothing_projected(self):
        for scene in ("limb_twist", "limb_bend"):
            self.assertEqual(self.holds_at_fewer_angles(scene, "_nothing", NOTHING), "not_reproduced")


if __name__ == "__main__":
    unittest.main()
