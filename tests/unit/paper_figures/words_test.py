"""Names, sentences and captions agree with the facts of small claims, with the rows behind a figure and with looks.toml, and captions
contain no number that another run would change. Reference: the definition, and looks.toml, with which checked_looks.py compares every
figure that other tests draw."""
import dataclasses
import importlib
import re
import tomllib
import unittest

from results_case import ResultsTest, root
import checked_looks
import make_all
import synthetic_records
from drawing import style
from figures import pbs_errors
from records import entries
from synthetic_records import claim, interval, judged_run, subject, value, write_table
from words import captions, case_words, looks, sentences


def told(**facts):
    return claim("C09", facts.pop("verdict", "not_reproduced"), titles=facts.pop("titles", {}), **facts)


def primary(quantity, number, bound_low, bound_high, **key):
    return {**key, "quantity": quantity, "statistic": "value", "unit": "1", "value": number, "low": number, "high": number,
            "bound_low": bound_low, "bound_high": bound_high}


class CaseWords(unittest.TestCase):
    def test_runs_are_named_in_words(self):
        keys = ({"body": "limb", "motion": "twist"}, {"body": "human", "motion": "01_01"},
                {"body": "frankie", "motion": "01_01", "variant": "jiggle"}, {"body": "lady", "motion": "01_03", "variant": "as_printed"},
                {"body": "ring"})
        self.assertEqual([case_words.run(key) for key in keys],
                         ["limb twisted", "human, clip 01_01", "frankie, clip 01_01, jiggling flesh", "lady, clip 01_03, as printed",
                           "ring"])

    def test_a_key_has_its_units_and_ranges(self):
        self.assertEqual(case_words.of({"body": "limb", "motion": "bend", "angle_deg": 90.0, "joint": "upper|forearm", "deformer": "lbs",
                                        "k_stretch": 0.05, "k_stretch_to": 1.0, "time_step_s": 0.02, "time_step_to_s": 0.005}),
                         "limb, bend 90\u00b0, upper|forearm, LBS, k_stretch 0.05 to 1, steps of 20 to 5 ms")
        self.assertEqual(case_words.of({"body": "man", "motion": "01_01", "pose": "in_the_air", "iterations": 24, "masses": "equal"}),
                         "man, clip 01_01, in the air, equal masses, 24 iterations")
        self.assertEqual(case_words.of({"body": "human", "motion": "01_01", "pose": "2_5_of_the_clip"}),
                         "human, clip 01_01, 2/5 of the clip")
        self.assertEqual(case_words.of({"body": "man", "motion": "01_01", "time_s": 4.0, "young_pa": 3e4}),
                         "man, clip 01_01 at 4 s, 30 kPa")
        self.assertEqual(case_words.of({}), "")

    def test_a_material_has_six_digits_of_poissons_ratio(self):
        self.assertEqual(case_words.material({"material": "neo_hookean", "poisson": repr(1 / 3)}), "neo-Hookean, nu = 0.333333")
        self.assertEqual(case_words.material({"material": "linear", "poisson": ""}), "linear")


class Bounds(unittest.TestCase):
    def test_a_bound_of_two_ends_one_or_none(self):
        ends = ((0.9, 1.1), (30.0, None), (None, 1.05), (0.0, 0.0), (None, None))
        self.assertEqual([sentences.bound(*of) for of in ends], ["0.9 to 1.1", "30 or more", "1.05 or less", "0", ""])

    def test_one_text_for_a_common_bound_else_one_for_each_quantity(self):
        def of(*bounds):
            return told(titles={"b": "breadth"}, bounds=[{"quantity": name, "low": 0.0, "high": high} for name, high in bounds])

        self.assertEqual(sentences.expected(of(("a", 1.0), ("b", 1.0))), ["0 to 1"])
        self.assertEqual(sentences.expected(of(("a", 1.0), ("b", 2.0))), ["a: 0 to 1", "breadth: 0 to 2"])
        self.assertEqual(sentences.expected(told(rule="untestable")), [])


class Outcome(unittest.TestCase):
    def test_what_fails_says_by_how_much(self):
        failing = told(titles={"ratio": "ratio of rates"}, n=2, subjects=[subject("limb", 0, 1, "none"), subject("man", 0, 1, "none")],
                       primary=primary("ratio", 2.0, 0.9, 1.1, body="man", time_step_s=0.01))
        self.assertEqual(sentences.outcome(failing),
                         "not for limb, man; farthest: ratio of rates of man, steps of 10 ms is 2, expected 0.9 to 1.1")
        self.assertEqual(sentences.outcome(failing, in_short=True), "not for limb, man; farthest: ratio of rates is 2, expected 0.9 to 1.1")

    def test_subjects_that_hold_in_part_are_counted(self):
        partly = told(verdict="reproduced_only_for", subject="masses", n=7, within=4,
                      subjects=[subject("equal", 3, 4, "part"), subject("unequal", 1, 1, "whole"),
                                 subject("unequal_by_eq_8_9", 0, 2, "none")])
        self.assertEqual(sentences.outcome(partly), "for equal masses (3 of 4 values), unequal masses; "
                                                    "not for unequal masses by Eq. 8\u20139, which are for m = 1")

    def test_a_value_that_is_not_a_number_is_said_so(self):
        broken = told(n=1, primary=primary("ratio", None, None, 1.0))
        self.assertEqual(sentences.farthest(broken), "farthest: ratio is not a number, expected 1 or less")

    def test_without_records_or_bodies_it_says_why(self):
        self.assertEqual(sentences.outcome(told(missing=["volume/walk"])), "without records of volume/walk")
        self.assertEqual(sentences.outcome(told(left_out=[{"scene": "man", "reason": "not installed"}])), "man is left out: not installed")
        self.assertEqual(sentences.outcome(told(reason="no value is in print")), "no value is in print")

    def test_other_metrics_and_orders_are_part_of_the_full_verdict(self):
        runs = [judged_run("limb", "twist", "part", interval(-0.2), interval(0.9), [[0.0, 175.0]])]
        runs.append(runs[0] | {"quantity": "volume_abs_change_pct", "holds": "none"})
        readings = [{"order": "plain", "precision": "f64", "verdict": "reproduced_only_for", "own_verdict": "reproduced_only_for",
                     "same": True, "differing": [], "cases": []},
                    {"order": "grouped", "precision": "f32", "verdict": "not_reproduced", "own_verdict": "reproduced_only_for",
                     "same": False, "differing": [0], "cases": runs[:1]}]
        full = sentences.verdict_in_full(told(
            verdict="reproduced_only_for", rule="share_within", cases=runs, readings=readings, n=1, bounds=[
            {"quantity": name, "low": -0.5, "high": 0.5} for name in ("volume_change_pct", "volume_abs_change_pct")]))
        self.assertEqual(full, ["reproduced in part: for limb twisted by 0 to 175 of 180\u00b0",
                                "by volume abs change pct: 0 of 1 run within the bound, 0 in part",
                                "the same verdict in order plain in double precision",
                                "not reproduced in order grouped in single precision, as against reproduced in part "
                                "(limb twisted by volume change pct)"])


class Controls(unittest.TestCase):
    def test_the_first_quantities_from_the_least_to_the_most(self):
        controls = [value("share_inverted", 0.5), value("pace", 30.0, unit="1/s"), value("share_inverted", 0.0)]
        self.assertEqual(sentences.controls(told(controls=controls)), "share inverted 0 to 0.5, pace 30 1/s")
        self.assertEqual(sentences.controls(told(controls=controls), most=1), "share inverted 0 to 0.5")
        self.assertEqual(sentences.controls(told()), "")

    def test_shares_of_trials_are_told_as_counts_over_all(self):
        controls = [value("share_of_cells_inverted", share) | {"n": n} for share, n in ((4 / 9, 9), (0.0, 4), (1.0, 6))]
        self.assertEqual(sentences.controls(told(controls=controls)), "10 of 19 trials end with inverted tets")
        del controls[1]["n"]
        self.assertEqual(sentences.controls(told(controls=controls)), "share of cells inverted 0 to 1")

    def test_the_same_quantity_of_another_key_is_a_group_of_its_own(self):
        controls = [value("pace", 48.1, order="plain", precision="f32"), value("pace", 265.0, order="ordered", precision="f32")]
        self.assertEqual(sentences.controls(told(controls=controls, of={"order": "plain", "precision": "f64"})),
                         "pace, plain, single precision 48.1, pace, ordered, single precision 265")


class Line(unittest.TestCase):
    def test_claims_of_many_quantities_tell_the_farthest_and_those_of_few_each_range(self):
        values = [value("a", 1.0), value("a", 2.0), value("b", 5.0)]

        def of(*bounds):
            return told(cases=values, n=3, within=2, primary=primary("b", 5.0, 0.0, 2.0),
                        bounds=[{"quantity": name, "low": 0.0, "high": high} for name, high in bounds])

        self.assertEqual(sentences.measured_in_line(of(("a", 2.0), ("b", 2.0))), "1 to 5; 2 of 3 values within the bound")
        self.assertEqual(sentences.measured_in_line(of(("b", 2.0), ("a", 3.0))), "5; 1 to 2; 2 of 3 values within the bound")
        self.assertEqual(sentences.measured_in_line(of(("a", 1.0), ("b", 2.0), ("c", 3.0), ("d", 4.0))),
                         "2 of 3 values within the bound; farthest: b is 5, expected 0 to 2")


class File(ResultsTest):
    def test_titles_are_attached_and_another_schema_is_refused(self):
        synthetic_records.write_claims(self.results)
        file = self.results / "claims.json"
        self.assertEqual(sentences.title(sentences.claims_of(file)[0], "volume_change_pct"), "volume change")
        file.write_text(file.read_text().replace('"schema": 2', '"schema": 1'))
        with self.refused("schema = 1: expected 2"):
            sentences.claims_of(file)

    def test_every_quantity_of_the_projects_claims_has_a_title(self):
        document = tomllib.loads((root / "experiments" / "verdicts" / "claims.toml").read_text())
        named = {name for one in document["claim"] for key in ("metrics", "reported") for name in one.get(key, [])}
        self.assertEqual(named - document["quantity"].keys(), set())
        self.assertEqual(document["quantity"].keys() - named, set())


class Looks(unittest.TestCase):
    def test_each_entry_is_whole_and_each_group_has_a_look_of_its_own(self):
        own = {name: entry for name, entry in looks.listed.items() if "group" not in entry}
        for name, entry in looks.listed.items():
            with self.subTest(name):
                self.assertIn(entry.get("group", name), own)
                self.assertEqual(set(entry), {"name", "group"} if "group" in entry else {"name", "color", "marker", "line"})
                self.assertRegex(looks.of(name).color, r"^#[0-9A-F]{6}$")
        self.assertEqual(len({(entry["color"], entry["marker"]) for entry in own.values()}), len(own))

    def test_a_deformer_that_is_not_listed_has_its_name_and_a_look_that_depends_on_nothing_else(self):
        listed = {entry.get("color") for entry in looks.listed.values()}
        self.assertFalse(listed & {color for color, _, _ in looks.own})
        first = looks.of("mine")
        for other in ("other_one", "linked"):
            self.assertNotEqual(looks.of(other), first)
        self.assertEqual((looks.of("mine"), first.name), (first, "mine"))

    def test_the_names_are_those_of_the_pages(self):
        for deformer in looks.listed:
            self.assertEqual(case_words.of_field("deformer", deformer), looks.of(deformer).name)

    def test_no_script_has_a_colour_of_a_deformer_of_its_own(self):
        named = re.compile(r"""["'](lbs|dqs|pbs|xpbd|vbd|nh_p[12]|delta_mush)["']\s*:\s*\(?[^\n]*(#[0-9A-Fa-f]{6}|style\.\w+)""")
        for file in (root / "paper_figures").rglob("*.py"):
            self.assertIsNone(named.search(file.read_text(encoding="utf-8")), file)

    def test_a_line_of_a_deformer_in_another_colour_is_found(self):
        figure, axes = style.panels(1, 1)
        look = looks.of("dqs")
        axes[0][0].plot([0, 1], [0, 1], color=look.color, marker=look.marker, label="DQS")
        self.assertEqual(checked_looks.wrongly_drawn(figure), [])
        axes[0][0].plot([0, 1], [0, 1], color=style.black, marker=look.marker, label="DQS, 90 degrees")
        axes[0][0].plot([0, 1], [0, 1], color=style.black, marker=look.marker, label="DQS (baseline)")
        axes[0][0].plot([0, 1], [0, 1], color=style.black, marker=look.marker, label="DQS-like")
        self.assertEqual(checked_looks.wrongly_drawn(figure), ["DQS, 90 degrees: #000000 s", "DQS (baseline): #000000 s"])

    def test_a_change_to_pbs_has_no_deformers_colour(self):
        taken = {entry.get("color") for entry in looks.listed.values()} | {color for color, _, _ in looks.own}
        self.assertFalse(taken & {color for color, _ in pbs_errors.changes.values()})


listed = {entry.name: entry for entry in entries.read()}
extents_differ = {"convergence", "jiggle", "stability", "stiffness", "volume", "work_precision"}  # a quick run has fewer settings
same_in_every_run = {"0.5 %", "8 frames in 10", "24 iterations", "after 24", "90 degrees", "2007", "4.5e15 N/m", "1 N", "1 m", "01_01",
                     "f32", "f64", "10, 5 and 2 %", "4, 24 and", "96 iterations"}


class Captions(ResultsTest):
    def told(self, name, rows):
        write_table(self.results / f"{name}.csv", rows)
        return captions.whole(listed[name], self.results, {"cpu_model": "a processor"})

    def test_each_states_the_facts_of_the_rows_behind_its_figure(self):
        for case in tomllib.loads((root / "tests/unit/paper_figures/captions.toml").read_text(encoding="utf-8"))["case"]:
            text = self.told(case["figure"], [dict(zip(case["columns"], row)) for row in case["rows"]])
            for words in case["states"]:
                with self.subTest(case["what"]):
                    self.assertIn(words, text)

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

    def test_figures_of_time_name_the_processor(self):
        timed = [entry for entry in listed.values() if set(entry.studies()) & {"timing", "work_precision"}]
        timed = [entry for entry in timed if entry.name != "error_parts"]
        self.assertEqual(len(timed), 8)
        for entry in timed:
            with self.subTest(entry.name):
                self.assertIn("{cpu}", entry.caption)
                self.assertIn("a processor", captions.whole(entry, self.results, {"cpu_model": "a processor"}))
                self.assertIn("a processor that is not on record", captions.whole(entry, self.results, {}))

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
