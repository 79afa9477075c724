"""Names, sentences and captions agree with the facts of small claims, with the rows behind a figure and with looks.toml, and captions
contain no number that another run would change. Reference: the definition, and looks.toml, with which checked_looks.py compares every
figure that other tests draw."""
import dataclasses
import pathlib
import re
import tomllib
import unittest

from results_case import ResultsTest, root
import checked_looks
import make_all
import records
import synthetic_records
from drawing import style
from records import entries
from synthetic_records import case, claim, selection, write_table
from words import captions, case_words, compared_methods, looks, sentences


class CaseWords(unittest.TestCase):
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
        self.assertEqual(case_words.of({"body": "limb", "joint": "upper|forearm", "angle_deg": 180.0}), "limb, 180\u00b0, upper|forearm")
        self.assertEqual(case_words.of({"body": "man", "pose": "in_the_air"}), "man, in the air")
        self.assertEqual(case_words.of({}), "")

    def test_a_material_has_six_digits_of_poissons_ratio(self):
        self.assertEqual(case_words.material({"material": "neo_hookean", "poisson": repr(1 / 3)}), "neo-Hookean, nu = 0.333333")
        self.assertEqual(case_words.material({"material": "linear", "poisson": ""}), "linear")


class Bounds(unittest.TestCase):
    def test_a_bound_of_two_ends_one_or_none(self):
        ends = ((0.9, 1.1), (30.0, None), (None, 1.05), (0.0, 0.0), (None, 0.9999999999999999), (1e-9, None), (None, 1e-12), (None, None))
        self.assertEqual([sentences.threshold(*of) for of in ends],
                         ["0.9 to 1.1", "30 or more", "1.05 or less", "0", "below 1", "above 0", "1e\u221212 or less", ""])

    def test_several_bounds_state_for_what_they_are(self):
        judged = claim("C07", "holds", titles={"left": "what is left"},
                       thresholds=[{"low": None, "high": 1e-5, "precision": "f32"}, {"low": None, "high": 0.05, "quantity": "left"}])
        self.assertEqual(sentences.expected(judged), ["single precision: 1e\u221205 or less", "what is left: 0.05 or less"])
        self.assertEqual(sentences.expected(claim("C14", "inconsistent_in_print", rule="printed")), ["each value as the others require"])


class Numbers(unittest.TestCase):
    def test_a_censored_value_is_never_a_number(self):
        for limit, words in (("more_than", "> 1,000"), ("at_least", "\u2265 1,000"), ("at_most", "\u2264 1,000")):
            self.assertEqual(sentences.shown(case(1000.0, limit=limit)), words)
        self.assertEqual(sentences.shown(case(1000.0)), "1000")
        self.assertEqual(sentences.shown(case(90.93, limit="at_least", unit="%")), "\u2265 90.9 %")

    def test_they_span_the_units_that_count(self):
        cases = [case(1000.0, limit="more_than"), case(13.0), case(2.0, excluded="nothing_to_see"), case(None)]
        self.assertEqual(sentences.span(sentences.counting({"cases": cases})), "13 to > 1,000; 1 value not a number")
        self.assertEqual([sentences.span(list(of)) for of in ((), [case(7.0, unit="%")], [case(1.0, unit="%"), case(2.0, unit="%")])],
                         ["", "7 %", "1 to 2 %"])

    def test_each_bound_has_the_numbers_to_which_it_applies(self):
        bounds = [{"low": None, "high": high, "precision": name} for name, high in (("f64", 1e-12), ("f32", 1e-5))]
        cases = [case(number, threshold_low=None, threshold_high=high) for number, high in ((2e-15, 1e-12), (1e-6, 1e-5), (4e-15, 1e-12))]
        self.assertEqual(sentences.numbers(claim("C07", "holds", cases, thresholds=bounds)),
                         ["ratio, double precision: 2e-15 to 4e-15, threshold 1e-12 or less".replace("-", "\u2212"),
                          "ratio, single precision: 1e-06, threshold 1e-05 or less".replace("-", "\u2212")])

    def test_each_quantity_of_a_unit_has_its_numbers(self):
        bounds = [{"low": 0.1, "high": None, "quantity": "damping"}, {"low": None, "high": 0.05, "quantity": "left"}]
        cases = [case(d, parts=[case(d, threshold_low=0.1, quantity="damping"),
                                case(r, threshold_low=None, threshold_high=0.05, quantity="left")])
                 for d, r in ((0.2, 0.01), (0.4, 0.07))]
        judged = claim("C09a", "mixed", cases, thresholds=bounds, quantities=["damping", "left"], titles={"left": "what is left"})
        self.assertEqual(sentences.numbers(judged),
                         ["damping: 0.2 to 0.4, threshold 0.1 or more", "what is left: 0.01 to 0.07, threshold 0.05 or less"])
        self.assertEqual(sentences.spans(judged, judged), "damping: 0.2 to 0.4; what is left: 0.01 to 0.07")
        self.assertIn("is the damping and what is left; threshold: ", sentences.basis(judged))

    def test_ranges_that_cross_the_bound_are_named(self):
        cases = [case(1.0, low=0.9, high=1.1, body=body) for body in ("limb", "man", "lady")] + [case(1.0), case(0.5, low=0.4, high=0.6)]
        self.assertEqual(sentences.ranges(claim("C04", "mixed", cases)), [
            "range over meshes of limb: 0.9 to 1.1", "range over meshes of man: 0.9 to 1.1",
            "the ranges of 1 more case cross the threshold"])
        self.assertEqual(sentences.ranges(claim("C04", "mixed", cases, range="")), [])


class Facts(unittest.TestCase):
    joints = [case(0.067, False)] + [case(1.0)] * 27 + [case(1.02), case(1.0, excluded="nothing_to_see")]

    def test_the_share_with_its_interval_then_the_numbers_then_what_is_left_out(self):
        judged = claim("C04", "holds", self.joints, interval_low=0.822, interval_high=0.999, chance=1e-30, q=0.06)
        self.assertEqual(sentences.facts(judged),
                         ["28 of 29 cases hold, share 0.966 [0.822, 0.999]", "ratio: 0.067 to 1.02, threshold 0.95 or more",
                          "1 case excluded: the negative control does not fail there"])

    def test_chance_is_stated_where_it_decides(self):
        cases = [case(1.0)] * 14 + [case(0.9, False)] * 4
        words = "chance alone reaches as many with probability 0.0154, where less than 0.01 is asked"
        for verdict, why, chance, stated in (("not_shown", "none", 0.0154, True), ("inconclusive", "chance", 0.0154, True),
                                             ("inconclusive", "too_few_cases", 0.0154, False), ("mixed", "none", 0.001, False),
                                             ("fails", "none", 0.9, False)):
            judged = claim("C06", verdict, cases, chance=chance, q=0.5, why_inconclusive=why)
            self.assertEqual(words in sentences.facts(judged), stated, verdict)

    def test_a_mixed_claim_names_the_property_by_which_its_cases_differ(self):
        judged = claim("C03", "mixed", [case(1.2), case(0.8, False)], differs={
            "field": "body", "least_at": "frankie", "least": 0.0, "most_at": "human", "most": 1.0})
        self.assertIn("the share differs most by body: 0 for frankie, 1 for human", sentences.facts(judged))

    def test_without_a_verdict_it_says_why(self):
        cases, silent = [case(1.0)] * 4, selection("DQS", (), "negative_control", False)
        wrong = selection("LBS", [case(1.0), case(0.0, False), case(1.0)], "negative_control", False)
        for facts, words in (({"why_inconclusive": "too_few_cases", "cases": cases, "n": 4}, "only 4 cases, fewer than five"),
                             ({"why_inconclusive": "too_few_cases"}, "no case is on record"),
                             ({"why_inconclusive": "control_without_record", "controls": [silent, silent]},
                              "no record of the controls DQS, DQS"),
                             ({"why_inconclusive": "control_misbehaves", "controls": [wrong]},
                              "the negative control LBS holds in 2 of 3 cases"),
                             ({"rule": "untestable", "reason": "no program"}, "no program"),
                             ({"missing": ["volume/walk"]}, "no record of volume/walk"),
                             ({"excluded_scenes": [{"scene": "man", "reason": "not installed"}]}, "man is excluded: not installed"),
                             ({}, "no record")):
            self.assertEqual(sentences.facts(claim("C05", "inconclusive", **facts))[-1], words)

    def test_printed_values_are_counted_and_a_single_number_has_the_range_that_decides(self):
        printed = [{"value": 1.0, "holds": holds, "threshold_low": None, "threshold_high": None} for holds in (True, False, True)]
        self.assertEqual(sentences.facts(claim("C14", "inconsistent_in_print", printed, rule="printed")),
                         ["2 of 3 printed values consistent"])
        exponent = case(0.42, low=0.21, high=0.63, threshold_low=1e-9)
        self.assertEqual(sentences.facts(claim("C12b", "holds", [exponent], rule="single", range="95 % range of the fit")),
                         ["ratio: 0.42 (95 % range of the fit: 0.21 to 0.63), threshold above 0"])
        self.assertEqual(sentences.facts(claim("C12b", "inconclusive", [exponent] * 2, rule="single",
                                               why_inconclusive="too_few_cases"))[-1],
                         "2 numbers are on record where one is expected")

    def test_a_definition_has_its_reason_and_its_numbers(self):
        cases = [case(factor, threshold_low=None) for factor in (1.85, 5.98)]
        judged = claim("C11", "definition", cases, rule="definition", reason="it defines k", titles={"ratio": "factor"}, thresholds=[])
        self.assertEqual(sentences.in_line(judged), "It defines k; factor: 1.85 to 5.98")

    def test_verdicts_are_counted_in_one_sentence(self):
        kinds = ["holds", "holds", "fails", "definition", "inconclusive", "untestable"]
        self.assertEqual(sentences.counts([claim("C01", kind) for kind in kinds]),
                         "There are 6 claims: 2 hold, 1 fails, 1 is inconclusive, 1 cannot be tested, 1 is a definition.")
        self.assertEqual(set(sentences.kinds), set(sentences.names))


class Basis(unittest.TestCase):
    def test_it_states_the_unit_its_number_the_bound_with_its_source_chance_and_the_revision(self):
        judged = claim("C04", "holds", [case(1.0)] * 5, chance=0.001, q=0.0625, fixed_at="0123456789abcdef",
                       case_fields=["body", "angle_deg"], titles={"ratio": "radius"}, over={"deformer": "reference"},
                       source="Fig. 8")
        self.assertEqual(
            sentences.basis(judged),
            "The number of a case (body, angle) is the radius, over that of the reference; threshold: 0.95 or more (Fig. 8). If each case "
            "held with probability q = 0.0625, at least as many would hold by chance with probability 0.001. This q is the share of the "
            "negative control, by the rule of succession, or one half. Rule and threshold are of revision 0123456789ab.")
        self.assertEqual(sentences.basis(claim("C13", "holds", rule="printed")), "")

    def test_when_threshold_and_rule_were_fixed_is_stated(self):
        judged = claim("C04", "holds", [case(1.0)] * 5, fixed_at="b" * 40, thresholds_fixed_at="a" * 40)
        self.assertIn("The threshold is of revision aaaaaaaaaaaa, the rule of revision bbbbbbbbbbbb.", sentences.basis(judged))
        later = claim("C04", "fails", [case(0.5, False)], fixed_at="b" * 40, thresholds_fixed_at="a" * 40)
        told, = sentences.on_held_out_cases(judged | {"held_out": later})
        self.assertIn("recorded after the thresholds were fixed and before the rule was mended, the verdict is 'fails'", told)

    def test_the_verdict_without_each_body(self):
        def told(**kinds):
            without = [{"body": body, "verdict": kind} for body, kind in kinds.items()]
            return sentences.without_a_body(claim("C04", "holds", without_body=without))

        self.assertEqual(told(), [])
        self.assertEqual(told(limb="holds", man="holds"), ["The verdict stays the same if any one body is excluded"])
        self.assertEqual(told(limb="holds", man="mixed"), ["If one body is excluded, the verdict changes: it is 'mixed' without man"])
        self.assertEqual(told(limb="inconclusive", lady="mixed", man="inconclusive", ring="inconclusive"),
                         ["If one body is excluded, the verdict changes: it is 'inconclusive' without any one of limb, man and ring and "
                          "'mixed' without lady"])

    def test_the_verdict_on_other_tets(self):
        def rows(name, held_out="", **kinds):
            return [{"claim": name, "size": size[1:].replace("_", "."), "human_vertices": "2115", "limb_vertices": "1573", "verdict": kind,
                     "held_out": held_out, "cases": "8", "holding": "1", "least": "-6.959", "most": "7.6", "unit": "%"}
                    for size, kind in kinds.items()]

        def sentence(**kinds):
            return sentences.on_other_tets(claim("C01", "fails"), rows("C01", **kinds) + rows("C04", _1_10="holds"))

        meshes = "On 2 other tet meshes of the human's and the limb's surfaces, with 0.90 to 1.10 times as many vertices, the verdict"
        self.assertEqual(sentences.on_other_tets(claim("C13", "holds"), rows("C01", _0_90="fails")), [])
        self.assertEqual(sentence(_0_90="fails", _1_00="fails", _1_10="fails"), [f"{meshes} is the same"])
        self.assertEqual(sentence(_0_90="mixed", _1_00="fails", _1_10="fails"), [f"{meshes} changes: it is 'mixed' on 1 of them"])
        self.assertEqual(sentence(_0_90="mixed", _1_10="holds"), [f"{meshes} changes: it is 'mixed' on 1 and 'holds' on 1 of them"])
        later = claim("C01", "fails", held_out=claim("C01", "holds"))
        self.assertEqual(sentences.on_other_tets(later, rows("C01", held_out="holds", _0_90="fails", _1_10="fails")),
                         [f"{meshes} is the same, and that on the held-out cases is the same"])
        self.assertEqual(sentences.other_tets_rows(claim("C01", "fails"), rows("C01", _0_90="not_shown") + rows("C04", _1_10="holds")),
                         [["0.90 times", "2115", "1573", "not shown", "\u2013", "1 of 8", "\u22126.96 to 7.6 %"]])

    def test_the_range_of_each_threshold(self):
        def told(low, high, **others):
            range_of = {"end": "high", "threshold": 1.05, "low": low, "high": high} | others
            return sentences.threshold_ranges(claim("C05", "holds", titles={"ratio": "radius"}, threshold_ranges=[range_of]))

        self.assertEqual(told(1.0468, 1.0642), ["With any upper threshold from 1.047 to 1.064 in place of 1.05, the verdict is the same"])
        self.assertEqual(told(None, 2.0, end="low"), ["With any lower threshold up to 2 in place of 1.05, the verdict is the same"])
        self.assertEqual(told(-1.0, None), ["With any upper threshold from \u22121 on in place of 1.05, the verdict is the same"])
        self.assertEqual(told(None, None, quantity="ratio", precision="f64"),
                         ["With any upper threshold of the double precision, radius in place of 1.05, the verdict is the same"])
        self.assertEqual(sentences.threshold_ranges(claim("C13", "holds")), [])

    def test_the_verdict_on_held_out_cases_stands_next_to_the_other(self):
        later = claim("C04", "fails", [case(0.5, False), case(1.0)], interval_low=0.01, interval_high=0.99)
        del later["titles"]  # claims.json has them once
        judged = claim("C04", "holds", [case(1.0)] * 5, held_out=later, titles={"ratio": "section radius"})
        self.assertEqual(sentences.both_verdicts(judged), "holds; on the held-out cases: fails")
        told, = sentences.on_held_out_cases(judged)
        self.assertIn("the verdict is 'fails': 1 of 2 cases hold, share 0.5 [0.01, 0.99]; section radius", told)
        self.assertEqual((sentences.both_verdicts(later), sentences.on_held_out_cases(later)), ("fails", []))
        self.assertEqual(sentences.both_verdicts(claim("C04", "holds", held_out=2)), "holds", "older records count these cases")
        self.assertEqual(case_words.of({"body": "human", "motion": "range_of_motion", "pose": "elbow_flexion+supination"}),
                         "human, elbow flexion and supination")


class Compared(unittest.TestCase):
    def test_a_control_has_its_role_and_whether_it_behaves(self):
        controls = [selection("LBS", [case(0.5, False), case(1.0)], "negative_control"),
                    selection("LBS", (), "positive_control", False, quantities=["ms"])]
        self.assertEqual(sentences.control_rows(claim("C04", "holds", controls=controls)), [
            ["LBS", "negative control", "1 of 2 cases, share 0.5", "0.5 to 1", "yes"],
            ["LBS (ms)", "positive control", "no record", "", "no"]])

    def test_a_comparison_without_a_bound_counts_its_units_alone(self):
        compared = [selection("flesh, nu 0.45", [case(0.5, False)]), selection("XPBD", [case(1.0)], thresholds=[]), selection("MLS")]
        self.assertEqual(sentences.compared_rows(claim("C04", "holds", compared=compared)), [
            ["flesh, nu 0.45", "0 of 1 case, share 0", "0.5"], ["XPBD", "1 case", "1"], ["MLS", "no record", ""]])

    def test_a_reading_has_its_least_and_most(self):
        readings = [selection("plain f32", [case(0.5, False), case(1.0)]), selection("")]
        self.assertEqual(sentences.reading_rows(claim("C04", "holds", readings=readings)), [
            ["plain f32", "1 of 2 cases, share 0.5", "0.5", "1"], ["not recorded", "no record", "", ""]])

    def test_a_reading_or_the_author_s_code_that_disagrees_is_named(self):
        holding, failing = ([case(value, holds, body=body) for body in "abcde"] for value, holds in ((1.0, True), (0.5, False)))
        judged = claim("C04", "holds", holding, readings=[selection("plain f32", holding), selection("grouped f32", failing)],
                       compared=[selection("DQS", failing), selection("the author's later code", failing[:2] + holding[2:])])
        told = sentences.disagreements(judged)
        self.assertEqual([text.split(" and ")[0] for text in told], ["Grouped f32", "The author's later code"])
        self.assertIn("the threshold holds in half of the cases or fewer in the one, throughout in the other", told[0])
        self.assertEqual(sentences.disagreements(claim("C04", "inconclusive", readings=[selection("plain f32", holding)])), [])


class File(ResultsTest):
    def test_titles_are_attached_and_another_schema_is_refused(self):
        synthetic_records.write_claims(self.results)
        file = self.results / "claims.json"
        self.assertEqual(sentences.title(sentences.claims_of(file)[0], "share_kept"), "share of frames")
        file.write_text(file.read_text().replace('"schema": 4', '"schema": 3'))
        with self.refused("schema = 3: expected 4"):
            sentences.claims_of(file)

    def test_every_quantity_of_the_projects_claims_has_a_title(self):
        document = tomllib.loads((root / "experiments" / "verdicts" / "claims.toml").read_text())
        selected = [of for one in document["claim"] for of in (one, *one.get("controls", []), *one.get("compared", []))]
        self.assertEqual({name for of in selected for name in of.get("quantities", [])} - document["quantity"].keys(), set())


class ComparedMethods(ResultsTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_work_precision(self.results)
        self.folder = self.results / "work_precision"

    def changed(self, table, change):
        """The comparison after a change to the rows of a table."""
        file = self.folder / f"{table}.csv"
        rows = [dict(row) for row in records.read_rows(file)]
        for row in rows:
            change(row)
        if table == "methods":  # the study sorts them
            rows.sort(key=lambda row: (row["table"], float(row["budget_ms"]), float(row["share"])))
        write_table(file, rows)
        return compared_methods.Compared(self.folder)

    def test_each_time_has_its_nearest_method_and_those_that_may_be_as_near(self):
        short, middle, _, clips = compared_methods.Compared(self.folder).answers()
        self.assertEqual(short, "Within 0.1 ms per frame, DQS leaves 86 % of LBS's error (10 mm from flesh on a body of 1.7 m; LBS may be "
                                "as near).")
        self.assertEqual(middle, "Within 1 ms, quasi-Newton leaves 32 % with the flesh known (3.8 mm); if bones hold the flesh as rigid "
                                 "capsules, vertex block descent is nearer. With guessed flesh, quasi-Newton leaves 48 % (5.8 mm; PBS and "
                                 "PBS with smooth weights may be as near); if bones hold the flesh as rigid capsules, vertex block descent "
                                 "is nearer. Of the methods that take nothing of the flesh, PBS leaves 57 % (6.8 mm).")
        self.assertEqual(clips, "Played along a clip, each frame from the one before, quasi-Newton leaves 16 to 24 % (the same frames "
                                "alone: 32 to 48 %) and PBS leaves 28 to 43 % (the same frames alone: 57 to 86 %) within 1 ms; "
                                "6 frames of each "
                                "clip have a reference.")

    def test_one_sentence_answers_for_who_has_to_choose(self):
        compared = compared_methods.Compared(self.folder)
        self.assertEqual(compared.headline(), "With 1 ms per frame, quasi-Newton has the least error: it leaves 32 % of the error of LBS "
                         "if material and springs of the flesh are known, and 48 % if they are guessed; of the methods that need none of "
                         "this, "
                         "PBS leaves 57 % and delta mush 75 %.")

        def takes_nothing(row):
            row["takes"] = "" if row["method"] == "quasi_newton" else row["takes"]

        self.assertEqual(self.changed("methods", takes_nothing).headline(),
                         "With 1 ms per frame, quasi-Newton has the least error: it leaves 32 % of the error of LBS.")

    def test_what_is_level_is_named_and_a_long_list_is_cut(self):
        def level(row):
            row["decision"] = "level" if "pbs" not in (row["first"], row["second"]) else row["decision"]

        self.assertIn("quasi-Newton leaves 32 % with the flesh known (3.8 mm; level with vertex block descent, neo-Hookean XPBD, XPBD, "
                      "projective dynamics and 4 more). With", self.changed("decisions", level).answer(1.0))

    def test_what_is_the_same_with_known_and_with_guessed_flesh_is_stated_once(self):
        def same(row):
            row["share"], row["skin_mm"] = (0.3, 4.0) if row["method"] == "pbs" else (0.6, 7.0)

        def decided(row):
            row["decision"] = {row["first"]: "first_is_nearer", row["second"]: "second_is_nearer"}.get("pbs", "level")

        self.changed("methods", same)
        self.assertEqual(self.changed("decisions", decided).answer(1.0), "Within 1 ms, PBS leaves 30 % (4.0 mm).")

    def test_the_nearest_is_the_one_that_no_other_is_decided_to_be_nearer_than(self):
        def reverse(row):
            if {row["first"], row["second"]} == {"quasi_newton", "vbd"}:
                row["decision"] = "second_is_nearer"  # vbd

        compared = self.changed("decisions", reverse)
        self.assertEqual(compared.nearest("known", 1.0)["method"], "vbd")
        self.assertEqual(compared.against("known", 1.0, "quasi_newton")["farther"], ["vbd"])
        self.assertIn("vbd", [*compared.against("known", 1.0, "pbs")["farther"]])

    def test_a_method_that_misses_the_time_is_no_answer(self):
        def late(row):
            row["within"] = "no" if row["method"] in ("quasi_newton", "vbd", "xpbd_neo_hookean") else row["within"]

        compared = self.changed("methods", late)
        self.assertEqual(compared.nearest("known", 1.0)["method"], "xpbd")
        self.assertEqual(compared_methods.cell(compared.row("known", 1.0, "vbd"))[-1], "\u2021")

        def all_late(row):
            row["within"] = "no"

        self.assertEqual(self.changed("methods", all_late).answer(1.0), "Within 1 ms, no method is fast enough on this machine.")

    def test_where_nothing_is_nearer_than_lbs_it_says_so(self):
        def lbs_first(row):
            row["share"] = 2.0 if row["method"] == "dqs" else row["share"]

        self.assertEqual(self.changed("methods", lbs_first).answer(0.1), "Within 0.1 ms per frame, no method is nearer than LBS (12 mm "
                         "from flesh on a body of 1.7 m; delta mush, direct delta mush and DQS may be as near).")

    def test_a_decision_that_depends_names_the_variants_on_which_the_other_is_nearer(self):
        def on_two(row):
            if row["member"] == "nu_0.3" and {row["first"], row["second"]} == {"quasi_newton", "vbd"}:
                row["wins"], row["losses"], row["p_holm"] = 3, 35, 0.001

        compared = compared_methods.Compared(self.folder)  # on nu_0.3 neither is
        self.assertEqual(compared.where_nearer("known", 1.0, "quasi_newton", "vbd"), ["smooth"])
        compared = self.changed("pairs", on_two)
        self.assertEqual(compared.where_nearer("known", 1.0, "vbd", "quasi_newton"), ["nu_0.3", "rigid_capsules"])
        self.assertEqual(compared.where_nearer("known", 1.0, "quasi_newton", "vbd"), ["smooth"])
        self.assertIn("; if the flesh can be compressed (Poisson\u2019s ratio 0.3) or bones hold the flesh as rigid capsules, vertex block "
                      "descent is nearer", compared.answer(1.0))

    def with_lbs_nearer_on(self, members):
        """quasi-Newton is nearer than LBS on all variants but these, on which no method is."""
        def change(row):
            if {row["first"], row["second"]} == {"quasi_newton", "lbs"}:
                far = row["first"] == "lbs"
                row["wins"], row["losses"] = (2, 36) if far else (36, 2)
                row["p_holm"] = 0.6 if row["member"] in members else 0.001

        return self.changed("pairs", change)

    def test_the_nearest_is_compared_with_the_familiar_ones_and_exceptions_are_named(self):
        rows = compared_methods.of_time(records.read_rows(self.folder / "pairs.csv"), "known", 1.0)
        all_of_them = [row["member"] for row in rows if {row["first"], row["second"]} == {"quasi_newton", "lbs"}]
        self.assertGreaterEqual(len(all_of_them), 3)
        self.assertEqual(self.with_lbs_nearer_on([]).familiar_ones("known", 1.0, "quasi_newton"), "nearer than LBS")
        self.assertEqual(self.with_lbs_nearer_on(["rigid_capsules"]).familiar_ones("known", 1.0, "quasi_newton"),
                         f"nearer than LBS for {len(all_of_them) - 1} of {len(all_of_them)} reference variants, not decided if bones hold "
                         "the flesh as rigid capsules")
        self.assertEqual(self.with_lbs_nearer_on(all_of_them[1:]).familiar_ones("known", 1.0, "quasi_newton"),
                         f"nearer than LBS for 1 of {len(all_of_them)} reference variants, not decided if "
                         f"{compared_methods.assumed(all_of_them[1:])}")
        self.assertEqual(self.with_lbs_nearer_on(all_of_them).familiar_ones("known", 1.0, "quasi_newton"), "")

    def test_each_reference_variant_has_its_words(self):
        source = (root / "experiments/studies/shared/posed_reference.cpp").read_text(encoding="utf-8")
        family = re.search(r"family\(\)\n\{(.*?)\n\}", source, re.S)[1]
        members = re.findall(r'\.name = "([\w.]+)"', family)
        self.assertEqual(set(members), set(case_words.tables["member"]))

    def test_without_clips_nothing_is_said_of_them(self):
        (self.folder / "motion.csv").unlink()
        self.assertEqual(len(compared_methods.Compared(self.folder).answers()), 3)

    def test_the_table_has_the_method_with_the_least_share_first_and_its_letters(self):
        table = list(compared_methods.Compared(self.folder).table("known"))
        self.assertEqual(len(table), 10)
        self.assertEqual(table[1], ["vertex block descent", "material, springs, initial guess", "", "34 [31, 41] b\u2020",
                                    "20 [18, 24] b\u2020"])
        self.assertIn(["DQS", "nothing", "86 [77, 103] a", "86 [77, 103] h", "86 [77, 103] h"], table)

    def test_pbs_has_its_range_and_its_distance(self):
        self.assertIn("PBS leaves 51 to 68 % of the error of LBS at the joints", compared_methods.Compared(self.folder).share_of_pbs())


class Looks(unittest.TestCase):
    def test_each_entry_is_whole_and_each_group_has_a_look_of_its_own(self):
        own = {name: entry for name, entry in looks.listed.items() if "group" not in entry}
        for name, entry in looks.listed.items():
            with self.subTest(name):
                self.assertIn(entry.get("group", name), own)
                whole = {"name", "group"} if "group" in entry else {"name", "color", "marker", "line"}
                self.assertEqual(set(entry) - {"short"}, whole)
                self.assertRegex(looks.of(name).color, r"^#[0-9A-F]{6}$")
        self.assertEqual(len({(entry["color"], entry["marker"]) for entry in own.values()}), len(own))

    def test_each_method_of_the_comparison_has_a_name_and_those_that_are_drawn_a_look_of_their_own(self):
        compared = tomllib.loads((root / "experiments/studies/work_precision/cases.toml").read_text(encoding="utf-8"))["method"]
        self.assertLessEqual({method["name"] for method in compared}, set(looks.listed))
        drawn = [looks.of(method["name"]) for method in compared if "known" in method["tables"]]
        self.assertEqual(len({look.color for look in drawn}), 10)

    def test_a_deformer_that_is_not_listed_has_its_name_and_a_look_that_depends_on_nothing_else(self):
        listed = {entry.get("color") for entry in looks.listed.values()}
        self.assertFalse(listed & {color for color, _, _ in looks.own})
        self.assertFalse(listed & {color for color in looks.palette.values() if isinstance(color, str)})  # of what is no deformer
        first = looks.of("mine")
        for other in ("other_one", "linked"):
            self.assertNotEqual(looks.of(other), first)
        self.assertEqual((looks.of("mine"), first.name), (first, "mine"))

    def test_a_figure_with_strange_colours_or_letters_or_labels_that_overlap_is_refused(self):
        def drawn(color=style.indigo, size=style.label_size, apart=0.3):
            figure, ((axes,),) = style.panels(1, 1)
            axes.plot([0, 1], [0, 1], color=color)
            axes.annotate("one", (0.5, 0.5), fontsize=size)
            axes.annotate("other", (0.5, 0.5 - apart))
            self.addCleanup(style.pyplot.close, figure)
            return figure

        checks = {"color": checked_looks.strange_colors, "size": checked_looks.strange_sizes, "apart": checked_looks.overlaps}
        for broken, found in ({"color": "#123456"}, ["#123456"]), ({"size": 9.0}, [9.0]), ({"apart": 0.0}, ["one | other"]):
            for name, check in checks.items():
                self.assertEqual(check(drawn(**broken)), found if name in broken else [], (name, broken))
            with self.assertRaisesRegex(AssertionError, "^broken: .*" + re.escape(str(found[0]))):
                style.save(drawn(**broken), pathlib.Path("broken"), {}, [])

    def test_labels_are_as_near_as_possible_to_their_lines(self):
        self.assertEqual(style.spread([1, 5, 9], [2, 2, 2], 0, 10), [1, 5, 9])
        self.assertEqual(style.spread([5, 5, 9], [2, 2, 2], 0, 10), [4, 6, 9])
        self.assertEqual(style.spread([5, 9.5, 9.5], [1, 2, 2], 0, 10), [5, 7, 9])
        self.assertEqual(style.spread([], [], 0, 10), [])

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
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS, 90 degrees")
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS (baseline)")
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS-like")
        self.assertEqual(checked_looks.wrongly_drawn(figure), ["DQS, 90 degrees: #262626 s", "DQS (baseline): #262626 s"])


listed = {entry.name: entry for entry in entries.read()}
extents_differ = {"convergence", "jiggle", "stability", "stiffness", "volume", "work_precision"}  # a quick run has fewer settings
same_in_every_run = {"0.5 %", "8 frames in 10", "24 iterations", "after 24", "90 degrees", "2007", "4.5e15 N/m", "1 N", "1 m", "01_01",
                     "95 %"}


class Captions(ResultsTest):
    def told(self, name, rows):
        write_table(self.results / f"{name}.csv", rows)
        return " ".join(captions.whole(listed[name], self.results, {"cpu_model": "a processor"}, part) for part in ("title", "caption"))

    def test_each_states_the_facts_of_the_rows_behind_its_figure(self):
        for case in tomllib.loads((root / "tests/unit/paper_figures/captions.toml").read_text(encoding="utf-8"))["case"]:
            text = self.told(case["figure"], [dict(zip(case["columns"], row)) for row in case["rows"]])
            for words in case["states"]:
                with self.subTest(case["what"]):
                    self.assertIn(words, text)

    def test_no_number_that_another_run_would_change_is_typed(self):
        for entry in listed.values():
            if extents_differ & set(entry.studies()):
                rest = re.sub(r"\{\w+\}", "", f"{entry.title} {entry.caption}")
                for words in same_in_every_run:
                    rest = rest.replace(words, "")
                self.assertEqual(re.findall(r"\d[\d.,]*", rest), [], entry.name)

    def test_figures_of_time_name_the_processor(self):
        timed = [entry for entry in listed.values() if set(entry.studies()) & {"timing", "work_precision"}]
        self.assertEqual(len(timed), 6)
        for entry in timed:
            with self.subTest(entry.name):
                write_table(self.results / f"{entry.name}.csv", [
                    {"shown": "answer", "text": "", "target_pct": 35, "budget_ms": 1, "method": "pbs", "solved_pct": 50, "poses": 40}])
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
        self.told("stability_maps", [{"map": "map_time_step_k_stretch.csv", "outcome": "bounded", "steps": 1}])
        with self.assertRaises(KeyError):
            captions.whole(dataclasses.replace(listed["stability_maps"], caption="see {nothing}"), self.results, {})


if __name__ == "__main__":
    unittest.main()
