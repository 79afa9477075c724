"""`pbskin bench` as users run it: the fields of the contract, finite positive numbers. The runs are quick, and no time
is judged. Reference: the contract in experiments/command_line/README.md."""
import json
import math
import os
import unittest

import foreign_arm
import program

RESULT = {"variant", "precision", "threads", "ns_stretch", "ns_volume", "ns_bind", "ms_step", "ratio_to_plain_spread",
          "ratio_to_plain", "residual_to_plain_spread", "volume_rms_to_plain_spread", "residual_to_plain",
          "volume_rms_to_plain"}


def numbers(value, path=""):
    """Every number in the record, with its place."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from numbers(part, f"{path}/{key}")
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from numbers(part, f"{path}/{index}")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path, value


class Bench(foreign_arm.ArmTest):
    of_arm = None

    def record(self, *arguments):
        return json.loads(self.succeeds("bench", "--quick", "--json", *arguments).stdout)

    def record_of_arm(self):
        """The same for all tests that read it."""
        if Bench.of_arm is None:
            Bench.of_arm = self.record("--mesh", self.path("arm.msh"))
        return Bench.of_arm

    def test_the_fields_of_the_contract(self):
        record = self.record("--mesh", self.path("arm.msh"), "--threads", "2")
        self.assertLessEqual({"context", "mesh", "results", "deformers", "meshes"}, record.keys())
        self.assertEqual(record["context"]["headline_ratio"], "ratio_to_plain_spread")
        self.assertEqual(len(record["context"]["busy_processors"]), 2)
        self.assertEqual(record["mesh"]["vertices"], 11 * 3 * 3)
        self.assertLessEqual({"edges", "tets"}, record["mesh"].keys())
        for result in record["results"]:
            self.assertLessEqual(RESULT, result.keys())
        kinds = [(result["variant"], result["precision"], result["threads"]) for result in record["results"]]
        self.assertEqual(len(kinds), len(set(kinds)))
        for precision in ("f32", "f64"):
            self.assertIn(("plain", precision, 1), kinds)
            for variant in ("ordered", "poses"):
                self.assertLessEqual({(variant, precision, 1), (variant, precision, 2)}, set(kinds))
        codes = {(timing["deformer"], timing["order"], timing["precision"]) for timing in record["deformers"]}
        self.assertLessEqual({("lbs", "plain", "f64"), ("lbs", "packed", "f32"), ("dqs", "packed", "f64")}, codes)

    def test_the_finite_elements_are_timed_per_solve_and_per_newton_step(self):
        record = self.record_of_arm()
        fem = {timing.get("model"): timing for timing in record["deformers"] if timing["deformer"] == "fem"}
        if None in fem:
            self.skipTest(fem[None]["left_out"])
        self.assertEqual(fem.keys(), {"linear", "stable_neo_hookean"})
        newton = fem["stable_neo_hookean"]
        self.assertTrue(newton["reached"])
        self.assertGreater(newton["iterations"], 1)
        self.assertAlmostEqual(newton["ms_iteration"] * newton["iterations"], newton["ms_frame"],
                               delta=1e-9 * newton["ms_frame"])
        for timing in fem.values():
            self.assertAlmostEqual(timing["ns_tet"] * record["mesh"]["tets"] * timing.get("iterations", 1),
                                   1e6 * timing["ms_frame"], delta=1e-3 * timing["ms_frame"])
            # There is no plain implementation.
            self.assertFalse([key for key in timing if key.startswith("ratio_to_plain")])

    def test_every_number_is_finite_and_every_time_positive(self):
        for path, value in numbers(self.record_of_arm()):
            self.assertTrue(math.isfinite(value), path)
            if any(name in path for name in ("/ns_", "/ms_frame", "/ms_step", "/ratio_to_", "gb_s")):
                self.assertGreater(value, 0, path)

    def test_ratios_are_to_plain_of_the_same_precision_and_to_plain_on_spread_constraints(self):
        record = self.record_of_arm()
        self.assertEqual({result["ratio_to_plain"] for result in record["results"] if result["variant"] == "plain"},
                         {1})
        self.assertEqual({one["ratio_to_plain_spread"] for one in record["yardsticks"]
                          if one["variant"] == "plain_spread"}, {1})

    def test_every_listed_deformer_is_timed(self):
        listed = {line.split()[0] for line in self.succeeds("list", "deformers").stdout.splitlines()
                  if line.startswith("  ")}
        timed = self.record_of_arm()["deformers"]
        # A scene's table defines these two.
        self.assertEqual({timing["deformer"] for timing in timed}, listed - {"external", "correctives"})
        for timing in timed:
            if "left_out" not in timing:
                ratio = set() if timing["deformer"] == "fem" else {"ratio_to_plain"}
                expected = {"ms_first", "ms_frame", "ns_tet", "ns_vertex", "precision"} | ratio
                self.assertLessEqual(expected, timing.keys(), timing["deformer"])
        for deformer in ("pbs", "xpbd"):
            codes = {(timing["order"], timing["precision"]) for timing in timed if timing["deformer"] == deformer}
            orders = "plain", "spread", "ordered"
            self.assertEqual(codes, {(order, precision) for order in orders for precision in ("f32", "f64")})

    def test_the_record_goes_into_a_folder(self):
        process = self.succeeds("bench", "--quick", "--mesh", self.path("arm.msh"), "-o", self.path("out"))
        self.assertIn("results", self.json("out", "bench.json"))
        for word in ("ordered", "poses", "ratio_to_plain_spread", "ratio_to_plain", "lbs", "xpbd", "gb_s"):
            self.assertIn(word, process.stdout)

    def test_sizes_tell_how_the_cost_grows(self):
        if "needs CGAL" in program.run("bench", "--quick", "--sizes", "1K").stderr:
            self.skipTest("a build without a mesher")
        record = self.record("--sizes", "2K,1K")
        self.assertLess(record["meshes"][0]["mesh"]["tets"], record["meshes"][1]["mesh"]["tets"])
        self.assertIn(("ordered", "f32"), [(fit["variant"], fit["precision"]) for fit in record["scaling"]])

    def test_what_cannot_be_written_is_refused_before_anything_is_read(self):
        os.makedirs(self.path("out", "bench.json"))
        self.refuses("bench.json: cannot be written: Is a directory", "bench", "--quick", "--mesh",
                     self.path("none.msh"), "-o", self.path("out"))


if __name__ == "__main__":
    unittest.main()
