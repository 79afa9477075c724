"""Reference: the definition. The numbers of a caption are those of the rows behind its figure, and it contains none that another run would
change."""
import dataclasses
import importlib
import re
import unittest

from results_case import ResultsTest
import make_all
import synthetic_records
from records import entries
from synthetic_records import write_table
from words import captions

listed = {entry.name: entry for entry in entries.read()}
extents_differ = {"convergence", "jiggle", "stability", "stiffness", "volume", "work_precision"}  # a quick run has fewer settings
same_in_every_run = {"0.5 %", "8 frames in 10", "24 iterations", "after 24", "90 degrees", "2007", "4.5e15 N/m", "1 N", "1 m", "01_01",
                     "f32", "f64", "10, 5 and 2 %", "4, 24 and", "96 iterations"}


class Captions(ResultsTest):
    def told(self, name, rows):
        write_table(self.results / f"{name}.csv", rows)
        return captions.whole(listed[name], self.results, {"cpu_model": "a processor"})

    def test_no_number_that_another_run_would_change_is_typed(self):
        for entry in listed.values():
            if extents_differ & set(entry.studies()):
                rest = re.sub(r"\{\w+\}", "", entry.caption)
                for words in same_in_every_run:
                    rest = rest.replace(words, "")
                self.assertEqual(re.findall(r"\d[\d.,]*", rest), [], entry.name)

    def test_every_caption_that_asks_has_a_script_that_tells(self):
        asking = [entry for entry in listed.values() if captions.asked(entry) - captions.of_runs]
        self.assertGreater(len(asking), 5)
        for entry in asking:
            script = importlib.import_module(f"figures.{entry.script}")
            self.assertTrue(callable(getattr(script, f"{entry.name}_facts", None)), entry.name)
        for entry in listed.values():
            if not captions.asked(entry):
                self.assertNotIn("{", entry.caption)

    def test_cells_are_counted_by_method_and_their_ends_named(self):
        rows = [{"model": model, "factor": factor, "outcome": outcome} for model, factor, outcome in (
            ("pbs", "gravity", "converged"), ("pbs", "gravity", "inverted"), ("pbs", "twist", "converged"),
            ("pbs_jiggle", "start", "bounded"), ("fem_linear", "gravity", "diverged"), ("fem_linear", "slivers_height_kept", "diverged"))]
        text = self.told("stability_cells", rows)
        self.assertIn("undisturbed: PBS in 2 of 3; PBS, jiggling in 0 of 1; linear FEM in 0 of 2 (", text)
        self.assertIn("PBS keeps inverted tets after: gravity; the jiggling PBS after: none. ", text)
        self.assertIn("Diverged: linear FEM (gravity and slivers, height kept); ", text)
        self.assertIn("Not finite: none.", text)

    def test_cells_of_each_map_are_counted(self):
        rows = [{"map": f"map_{name}.csv", "outcome": outcome, "steps": steps} for name, outcome, steps in (
            ("time_step_k_stretch", "inverted", 23), ("time_step_k_stretch", "converged", 611), ("iterations_twist", "bounded", 90))]
        text = self.told("stability_maps", rows)
        self.assertIn("k_stretch: of 2 cells 1 at rest as if undisturbed, 0 bounded, 1 with inverted tets, 0 diverged, 0 not finite.", text)
        self.assertIn("twist: of 1 cells 0 at rest as if undisturbed, 1 bounded, ", text)
        self.assertIn("The longest took 611 steps", text)

    def test_folds_of_frequency_are_largest_over_smallest(self):
        rows = [{"body": body, "varied": varied, "frequency_hz": hz, "deformer": "nh_p1" if pa else "pbs", "young_pa": pa or "nan"}
                for body, varied, hz, pa in (
                    ("limb", "k_stretch", 10, ""), ("limb", "k_stretch", 5, ""), ("limb", "k_stretch", 8, ""), ("man", "k_stretch", 7, ""),
                    ("limb", "iterations", 4, ""), ("limb", "iterations", 6, ""), ("limb_reference", "", 99, ""),
                    ("limb_reference", "", 98, 117e3), ("limb_reference", "", 97, 121e3))]
        text = self.told("jiggle_response", rows)
        self.assertIn("each with the others at k_stretch 0.1, 10 ms and 24 iterations.", text)
        self.assertIn("Young's modulus (117 to 121 kPa) is chosen so that they swing as fast as PBS, so only the damping", text)
        self.assertIn("changes with k_stretch 2-fold (limb); with the time step, which is no material property, none; "
                      "with the iterations 1.5-fold (limb).", text)

    def test_folds_of_stiffness_are_of_xpbd_over_iterations(self):
        rows = [{"body": body, "varied": varied, "method": method, "iterations": count, "stiffness_n_m": stiffness}
                for body, varied, method, count, stiffness in (
                    ("bar", "iterations", "xpbd", 6, 10), ("bar", "iterations", "xpbd", 48, 25), ("bar", "time_step_ms", "xpbd", 24, 999),
                    ("bar", "iterations", "pbs", 48, 500), ("human", "iterations", "xpbd_small_steps", 6, 4),
                    ("human", "iterations", "xpbd_small_steps", 48, 5))]
        text = self.told("stiffness", rows)
        self.assertIn("others at 24 iterations and 10 ms; PBS with the exponent has k_stretch 0.2.", text)
        self.assertIn("grows 2.5-fold (bar, 6 to 48) with the iterations; in small steps 1.25-fold (human, 6 to 48).", text)

    def test_linear_elements_are_told_apart_from_the_truth(self):
        def row(problem, quantity, order, difference="", ratio=""):
            return {"problem": problem, "quantity": quantity, "element_order": order, "difference_pct": difference,
                    "value_over_reference": ratio}

        rows = [row("locking", "tip_deflection", order, -50, ratio) for order, ratio in (
            (1, 0.5), (1, 0.0125), (2, 0.75), (2, 0.875), ("", 0.001))]
        rows += [row("locking", "torque", 1, 37, 1.37), row("thick_plate", "another", 2, 99)]
        rows += [row("thick_plate", "stress_yy_at_d", order, pct) for order, pct in ((1, -47), (1, 12), (2, -1.5), (2, 1))]
        text = self.told("verification", rows)
        self.assertIn("keep 75 to 87.5 % of a beam's bending towards incompressibility and meet published benchmarks within 1.5 %.", text)
        self.assertIn("lock: they keep 1.25 to 50 % of the bending and miss benchmarks by up to 47 %.", text)

    def test_figures_of_time_name_the_processor(self):
        timed = [entry for entry in listed.values() if set(entry.studies()) & {"timing", "work_precision"}]
        timed = [entry for entry in timed if entry.name != "error_parts"]
        self.assertEqual(len(timed), 8)
        for entry in timed:
            with self.subTest(entry.name):
                self.assertIn("{cpu}", entry.caption)
                self.assertIn("a processor", captions.whole(entry, self.results, {"cpu_model": "a processor"}))
                self.assertIn("a processor that is not on record", captions.whole(entry, self.results, {}))

    def test_a_ladder_is_told_by_its_ends(self):
        def row(ladder, vertices, residual, error):
            return {"ladder": f"ladder_{ladder}", "vertices": vertices, "iterations": 1000, "residual_24": residual, "last_residual": 0.01,
                    "volume_abs_change_24_pct": 2, "last_volume_abs_change_pct": 0.25, "error_24_pct": error, "last_error_pct": 40,
                    "volume_reached": int(vertices > 500)}

        rows = [row("bend", 900, 0.5, "nan"), row("bend", 300, 0.25, "nan"), row("twist", 300, 0.125, 23), row("twist", 600, 0.3, 21),
                row("twist", 900, 0.75, "nan")]
        text = self.told("convergence_mesh", rows)
        self.assertIn("limb, 300 to 900 vertices, after 24 iterations (filled) and after 1000 (hollow)", text)
        self.assertIn("In the bend, the residual on the coarsest and the finest mesh is 0.25 and 0.5 after 24 iterations and 0.01 and 0.01",
                      text)
        self.assertIn("reached on 1 of 2 meshes in the bend and on 2 of 3 in the twist", text)
        self.assertIn("twisted 23 % after 24 and 40 % after 1000 on 300 vertices, 21 % after 24 and 40 % after 1000 on 600 vertices; "
                      "bent no reference on record.", text)

    def test_inverted_tets_of_stills_and_clip(self):
        rows = [{"deformer": deformer, "inverted_tets": count} for deformer, count in (
            ("lbs", 73), ("lbs", 109), ("pbs", 0), ("pbs", 1), ("nh_p1", 0), ("nh_p1", 12))]
        self.assertIn("LBS inverts 73 to 109 tets and PBS 0 to 1; the finite elements, which are the reference, invert 0 to 12",
                      self.told("frames_skin", rows))
        self.assertIn("inverted tets in 1 of 2 frames. LBS has up to 109 inverted tets, PBS up to 1.", self.told("clip_jump", rows))

    def test_where_the_jiggling_skin_is_farthest(self):
        rows = [{"largest_mm": mm, "farthest_bone": bone, "time_s": time_s} for mm, bone, time_s in (
            (31.9, "upper_arm.R", 0.0), (65.1, "neck", 1.92))]
        text = self.told("fig_09_jiggle", rows)
        self.assertIn("The largest distances: 32 mm at the right upper arm (0.00 s), 65 mm at the neck (1.92 s).", text)
        self.assertIn("moved yet: 32 mm at the right upper arm (0.00 s) is softness", text)

    def test_it_is_written_with_the_figure_and_deleted_with_it(self):
        synthetic_records.write_study(self.results)
        self.make_all("volume_over_iterations")
        file = self.results / "figures" / "volume_over_iterations.caption.txt"
        text = file.read_text()
        self.assertIn("the signed change is \u22122 % for the human's median and \u22120.00375 % for the limb bent by 90 degrees; "
                      "after 96 iterations it is \u22122 %", text)
        self.assertEqual(captions.read(listed["volume_over_iterations"], file.parent), text.rstrip("\n"))
        make_all.delete("volume_over_iterations", file.parent)
        self.assertFalse(file.exists())
        with self.refused("volume_over_iterations.caption.txt: does not exist"):
            captions.read(listed["volume_over_iterations"], file.parent)

    def test_a_number_that_no_script_tells_is_an_error(self):
        rows = [{"map": "map_time_step_k_stretch.csv", "outcome": "bounded", "steps": 1}]
        self.told("stability_maps", rows)
        with self.assertRaises(KeyError):
            captions.whole(dataclasses.replace(listed["stability_maps"], caption="see {nothing}"), self.results, {})


if __name__ == "__main__":
    unittest.main()
