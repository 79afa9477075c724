"""The pages of studies. Reference: the kept records, whose pages are kept too, and tables made by hand."""
import importlib
import json
import tomllib
import unittest

from results_case import ResultsTest, root
import pages
from pages import ambiguity, artefacts, ensemble, stiffness, work_precision
from records import kept
from synthetic_records import write_table

KEPT = root / "experiments" / "records" / "full"


class Pages(ResultsTest):
    def test_those_of_the_kept_records_are_current(self):
        opened = kept.opened(KEPT)
        for study in pages.studies:
            page = importlib.import_module(f"pages.{study}").page
            self.assertEqual((KEPT / study / f"{study}.md").read_text(encoding="utf-8"), page(opened / study), study)

    def test_pairs_that_differ_notably_are_counted_and_the_others_left_out(self):
        pair = {"body": "human", "motion": "01_01", "pose": "crouch", "angle_deg": "", "first_is_closer": "1", "second_is_closer": "0"}
        text = ensemble.of_pairs([pair | {"first": first, "second": second, "largest_difference_pct": points, "decision": decision}
                                  for first, second, points, decision in (
                                      ("lbs", "pbs", "3.0", "decided"), ("dqs", "pbs", "2.5", "models_disagree"),
                                      ("lbs", "fem_linear", "9.0", "decided"), ("lbs", "dqs", "1.0", "reference_error"))])
        self.assertIn("2 of 3 pairs of deformers", text)
        self.assertIn("these are 1 of 2 pairs", text)
        self.assertIn("| human | 01_01 | crouch | DQS | PBS | 2.5 |", text)

    def test_references_that_decide_nothing_are_listed_with_their_worst_tet(self):
        member = {"body": "limb", "motion": "bend", "pose": "", "angle_deg": "90", "worst_tet": "1234", "j_min": "-0.5", "inverted": "3",
                  "lowest_det_f": "", "solve_s": "90"}
        text = ensemble.of_members([member | {"member": name, "outcome": outcome, "error_bound_pct": bound} for name, outcome, bound in (
            ("smooth", "reached", "0.1"), ("nu_0.49", "reached", ""), ("nu_0.3", "not_converged", ""))])
        self.assertIn("2 of 3 references were reached. 1 of these", text)
        self.assertIn("| nu_0.3 | not_converged | 1234 | -0.500 | 3 |", text)
        self.assertNotIn("| smooth |", text)
        self.assertIn("| limb | bend | 90\u00b0 | 4.5 |", text)

    def test_a_change_without_a_value_in_every_pose_is_not_ranked(self):
        row = {"group": "all", "budget_iterations": "24", "than": "pbs", "error_pct": "4", "than_error_pct": "10", "gain_pct": "6",
               "gain_low_pct": "5", "gain_high_pct": "7", "reference_error_pct": "6.5", "decision": "reference_error", "settings": "",
               "iterations": "9", "volume_abs_pct": "1"}
        write_table(self.results / "gains.csv", [row | {"change": "better", "poses": "4"}, row | {"change": "in_one_pose", "poses": "1"}])
        text = work_precision.gains(self.results)
        self.assertIn("Not ranked, because no setting fits into the budget in every pose: in one pose (1 of 4 poses).", text)
        self.assertIn("the reference's own error may change it by 6.5 points", text)

    def test_a_reading_shows_the_value_that_flips_or_changes_most(self):
        row = {"verdict_flips": "no", "a": "2", "b": "3", "change": "1", "b_over_a": "1.5"}
        flips = row | {"verdict_flips": "yes", "b_over_a": "1.1", "change": "0.2"}
        for shown, rows in (("x1.5", [row]), ("x1.1!", [row | {"b_over_a": "9"}, flips]), ("x9", [row, row | {"b_over_a": "9"}]),
                            ("0>0.5!", [flips | {"a": "0", "b": "0.5", "b_over_a": ""}]),
                            (".", [{"verdict_flips": "not_touched", "change": ""}]), ("", []),
                            ("-", [row | {"verdict_flips": "no_value", "a": "", "b": "", "change": "", "b_over_a": ""}]),
                            ("-!", [flips | {"b": "", "change": "", "b_over_a": ""}])):
            self.assertEqual(ambiguity.cell(rows), shown)

    def test_a_claim_states_which_readings_flip_it_and_why_others_have_no_value(self):
        rows = [{"body": "limb", "reading_b": name, "quantity": quantity, "verdict_flips": flips, "reason": reason}
                for name, quantity, flips, reason in (
                    ("B", "ratio", "yes", ""), ("C", "ratio", "no", ""), ("B", "share", "no_value", "four settings"),
                    ("B", "range", "no_value", "four settings"), ("D", "", "not_touched", "another factor is no more work"))]
        self.assertEqual(ambiguity.of_claim("C09", rows), "- C09: 1 of 2 values flip by limb, B\n  - not touched where another factor is "
                         "no more work\n  - no value: four settings: share, range\n")

    def test_sections_are_counted_by_outcome_and_those_left_out_named(self):
        row = {"claim": "C05", "body": "human", "joint": "elbow", "remark": ""}
        text = artefacts.of_sections([row | {"pose": "bend_45", "outcome": "measured"}, row | {"pose": "bend_90", "outcome": "too_far"},
                                      row | {"pose": "crouch", "outcome": "measured", "remark": "pbs is wide"}])
        self.assertEqual(text, "- C05: 2 sections measured\n- C05: 1 sections too_far: human bend_90 elbow\n\n## Remarks\n\n"
                         "- C05: human crouch elbow, measured: pbs is wide\n")

    def test_the_bounds_of_the_stiffness_are_those_of_the_claim(self):
        claims = tomllib.loads((root / "experiments" / "verdicts" / "claims.toml").read_text(encoding="utf-8"))["claim"]
        self.assertEqual([(claim["low"], claim["high"]) for claim in claims if claim["id"] == "C11"], [stiffness.bounds])

    def test_a_study_without_records_has_no_page(self):
        self.assertEqual(pages.write(self.results), [])
        (self.results / "ensemble").mkdir()
        (self.results / "ensemble" / "plan.json").write_text(json.dumps({"runs": []}), encoding="utf-8")
        self.assertEqual(pages.write(self.results), [], "its tables are missing")


if __name__ == "__main__":
    unittest.main()
