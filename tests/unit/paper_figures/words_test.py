"""Names of cases and sentences about claims agree with the facts of small claims. Reference: the definition."""
import tomllib
import unittest

from results_case import ResultsTest, root
import synthetic_records
from synthetic_records import case, claim, selection
from words import case_words, methods_of_run, sentences


class CaseWords(unittest.TestCase):
    def test_a_key_has_its_units_and_ranges(self):
        self.assertEqual(case_words.of({"body": "limb", "motion": "bend", "angle_deg": 90.0, "joint": "upper|forearm",
                                        "deformer": "lbs", "k_stretch": 0.05, "k_stretch_to": 1.0, "time_step_s": 0.02,
                                        "time_step_to_s": 0.005}),
                         "limb, bend 90\u00b0, upper|forearm, LBS, k_stretch 0.05 to 1, steps of 20 to 5 ms")
        self.assertEqual(case_words.of({"body": "man", "motion": "01_01", "pose": "in_the_air", "iterations": 24,
                                        "masses": "equal"}),
                         "man, clip 01_01, in the air, equal masses, 24 iterations")
        self.assertEqual(case_words.of({"body": "human", "motion": "01_01", "pose": "2_5_of_the_clip"}),
                         "human, clip 01_01, 2/5 of the clip")
        self.assertEqual(case_words.of({"body": "man", "motion": "01_01", "time_s": 4.0, "young_pa": 3e4}),
                         "man, clip 01_01 at 4 s, 30 kPa")
        self.assertEqual(case_words.of({"body": "limb", "joint": "upper|forearm", "angle_deg": 180.0}),
                         "limb, 180\u00b0, upper|forearm")
        self.assertEqual(case_words.of({"body": "man", "pose": "in_the_air"}), "man, in the air")
        self.assertEqual(case_words.of({}), "")

    def test_a_material_has_six_digits_of_poissons_ratio(self):
        self.assertEqual(case_words.material({"material": "neo_hookean", "poisson": repr(1 / 3)}),
                         "neo-Hookean, nu = 0.333333")
        self.assertEqual(case_words.material({"material": "linear", "poisson": ""}), "linear")


class MethodsOfRun(unittest.TestCase):
    def test_the_volume_changes_most_and_least_by_its_size_not_its_sign(self):
        changes = {"DQS": -0.2, "LBS": -3.0, "PBS": 0.25, "FEM": None}
        self.assertEqual(methods_of_run.largest_change([{"name": name, "volume_pct": change}
                                                        for name, change in changes.items()]),
                         "The volume changes most under LBS, by \u22123 %, and least under DQS, by \u22120.2 %")


class Bounds(unittest.TestCase):
    def test_several_bounds_state_for_what_they_are(self):
        judged = claim("C07", "holds", titles={"left": "what is left"},
                       thresholds=[{"low": None, "high": 1e-5, "threshold": "1e-05 or less", "precision": "f32"},
                                   {"low": None, "high": 0.05, "threshold": "0.05 or less", "quantity": "left"}])
        self.assertEqual(sentences.expected(judged), ["single precision: 1e\u221205 or less",
                                                      "what is left: 0.05 or less"])
        self.assertEqual(sentences.expected(claim("C14", "inconsistent_in_print", rule="printed")),
                         ["each value as the others require"])


class Numbers(unittest.TestCase):
    def test_a_censored_value_is_never_a_number(self):
        for limit, words in (("more_than", "> 1,000"), ("at_least", "\u2265 1,000"), ("at_most", "\u2264 1,000")):
            self.assertEqual(sentences.shown(case(1000.0, limit=limit)), words)
        self.assertEqual(sentences.shown(case(1000.0)), "1000")
        self.assertEqual(sentences.shown(case(90.93, limit="at_least", unit="%")), "\u2265 90.9 %")

    def test_they_span_the_units_that_count(self):
        cases = [case(1000.0, limit="more_than"), case(13.0), case(2.0, excluded="nothing_to_see"), case(None)]
        self.assertEqual(sentences.span(sentences.counting({"cases": cases})), "13 to > 1,000; 1 value not a number")
        self.assertEqual([sentences.span(list(of)) for of in ((), [case(7.0, unit="%")],
                                                              [case(1.0, unit="%"), case(2.0, unit="%")])],
                         ["", "7 %", "1 to 2 %"])

    def test_each_bound_has_the_numbers_to_which_it_applies(self):
        bounds = [{"low": None, "high": high, "precision": name} for name, high in (("f64", 1e-12), ("f32", 1e-5))]
        cases = [case(number, threshold_low=None, threshold_high=high, threshold=f"{high:g} or less")
                 for number, high in ((2e-15, 1e-12), (1e-6, 1e-5), (4e-15, 1e-12))]
        self.assertEqual(sentences.numbers(claim("C07", "holds", cases, thresholds=bounds)),
                         ["ratio, double precision: 2e-15 to 4e-15, threshold 1e-12 or less".replace("-", "\u2212"),
                          "ratio, single precision: 1e-06, threshold 1e-05 or less".replace("-", "\u2212")])

    def test_each_quantity_of_a_unit_has_its_numbers(self):
        bounds = [{"low": 0.1, "high": None, "threshold": "0.1 or more", "quantity": "damping"},
                  {"low": None, "high": 0.05, "threshold": "0.05 or less", "quantity": "left"}]
        cases = [case(d, parts=[case(d, threshold_low=0.1, threshold="0.1 or more", quantity="damping"),
                                case(r, threshold_low=None, threshold_high=0.05, threshold="0.05 or less",
                                     quantity="left")])
                 for d, r in ((0.2, 0.01), (0.4, 0.07))]
        judged = claim("C09a", "mixed", cases, thresholds=bounds, quantities=["damping", "left"],
                       titles={"left": "what is left"})
        self.assertEqual(sentences.numbers(judged),
                         ["damping: 0.2 to 0.4, threshold 0.1 or more",
                          "what is left: 0.01 to 0.07, threshold 0.05 or less"])
        self.assertEqual(sentences.spans(judged, judged), "damping: 0.2 to 0.4; what is left: 0.01 to 0.07")
        self.assertIn("is the damping and what is left. The thresholds are damping: ", sentences.basis(judged))

    def test_ranges_that_cross_the_bound_are_named(self):
        cases = [case(1.0, low=0.9, high=1.1, body=body)
                 for body in ("limb", "man", "lady")] + [case(1.0), case(0.5, low=0.4, high=0.6)]
        self.assertEqual(sentences.ranges(claim("C04", "mixed", cases)), [
            "range over meshes of limb: 0.9 to 1.1", "range over meshes of man: 0.9 to 1.1",
            "the ranges of 1 more case cross the threshold"])
        self.assertEqual(sentences.ranges(claim("C04", "mixed", cases, range="")), [])


class Facts(unittest.TestCase):
    joints = [case(0.067, False)] + [case(1.0)] * 27 + [case(1.02), case(1.0, excluded="nothing_to_see")]

    def test_the_share_with_its_interval_then_the_numbers_then_what_is_left_out(self):
        judged = claim("C04", "holds", self.joints, interval_low=0.822, interval_high=0.999, chance=1e-30, q=0.06)
        self.assertEqual(sentences.facts(judged),
                         ["28 of 29 cases hold, share 0.966 [0.822, 0.999]",
                          "ratio: 0.067 to 1.02, threshold 0.95 or more",
                          "1 case excluded: the negative control does not fail there"])

    def test_chance_is_stated_where_it_decides(self):
        cases = [case(1.0)] * 14 + [case(0.9, False)] * 4
        words = "chance alone reaches as many with probability 0.0154, where less than 0.01 is asked"
        for verdict, why, chance, stated in (("not_shown", "none", 0.0154, True),
                                             ("inconclusive", "chance", 0.0154, True),
                                             ("inconclusive", "too_few_cases", 0.0154, False),
                                             ("mixed", "none", 0.001, False), ("fails", "none", 0.9, False)):
            judged = claim("C06", verdict, cases, chance=chance, q=0.5, why_inconclusive=why)
            self.assertEqual(words in sentences.facts(judged), stated, verdict)

    def test_a_mixed_claim_names_the_property_by_which_its_cases_differ(self):
        judged = claim("C03", "mixed", [case(1.2), case(0.8, False)], differs={
            "field": "body", "least_at": "frankie", "least": 0.0, "most_at": "human", "most": 1.0})
        self.assertIn("the share differs most by body: 0 for frankie, 1 for human", sentences.facts(judged))

    def test_without_a_verdict_it_says_why(self):
        cases, silent = [case(1.0)] * 4, selection("DQS", (), "negative_control", False)
        wrong = selection("LBS", [case(1.0), case(0.0, False), case(1.0)], "negative_control", False)
        for facts, words in (({"why_inconclusive": "too_few_cases", "cases": cases, "n": 4},
                              "only 4 cases, fewer than five"),
                             ({"why_inconclusive": "too_few_cases"}, "no case is on record"),
                             ({"why_inconclusive": "control_without_record", "controls": [silent, silent]},
                              "no record of the controls DQS, DQS"),
                             ({"why_inconclusive": "control_misbehaves", "controls": [wrong]},
                              "the negative control LBS holds in 2 of 3 cases"),
                             ({"rule": "untestable", "reason": "no program"}, "no program"),
                             ({"missing": ["volume/walk"]}, "no record of volume/walk"),
                             ({"excluded_scenes": [{"scene": "man", "reason": "not installed"}]},
                              "man is excluded: not installed"),
                             ({}, "no record")):
            self.assertEqual(sentences.facts(claim("C05", "inconclusive", **facts))[-1], words)

    def test_printed_values_are_counted_and_a_single_number_has_the_range_that_decides(self):
        printed = [{"value": 1.0, "holds": holds, "threshold_low": None, "threshold_high": None}
                   for holds in (True, False, True)]
        self.assertEqual(sentences.facts(claim("C14", "inconsistent_in_print", printed, rule="printed")),
                         ["2 of 3 printed values consistent"])
        exponent = case(0.42, low=0.21, high=0.63, threshold_low=1e-9, threshold="above 0")
        self.assertEqual(sentences.facts(claim("C12b", "holds", [exponent], rule="single",
                                               range="95 % range of the fit")),
                         ["ratio: 0.42 (95 % range of the fit: 0.21 to 0.63), threshold above 0"])
        self.assertEqual(sentences.facts(claim("C12b", "inconclusive", [exponent] * 2, rule="single",
                                               why_inconclusive="too_few_cases"))[-1],
                         "2 numbers are on record where one is expected")

    def test_a_definition_has_its_reason_and_its_numbers(self):
        cases = [case(factor, threshold_low=None, threshold="") for factor in (1.85, 5.98)]
        judged = claim("C11", "definition", cases, rule="definition", reason="it defines k", titles={"ratio": "factor"},
                       thresholds=[])
        self.assertEqual(sentences.in_line(judged), "It defines k. Factor: 1.85 to 5.98")

    def test_verdicts_are_counted_in_one_sentence(self):
        kinds = ["holds", "holds", "fails", "definition", "inconclusive", "untestable"]
        self.assertEqual(sentences.counts([claim("C01", kind) for kind in kinds]),
                         "There are 6 claims: 2 hold, 1 fails, 1 is inconclusive, 1 cannot be tested, "
                         "1 is a definition.")
        self.assertEqual(set(sentences.kinds), set(sentences.names))


class Basis(unittest.TestCase):
    def test_it_states_the_unit_its_number_the_bound_with_its_source_chance_and_the_revision(self):
        judged = claim("C04", "holds", [case(1.0)] * 5, chance=0.001, q=0.0625, fixed_at="0123456789abcdef",
                       case_fields=["body", "angle_deg"], titles={"ratio": "radius"}, over={"deformer": "reference"},
                       source="Fig. 8")
        self.assertEqual(
            sentences.basis(judged),
            "The number of a case (body, angle) is the radius, over that of the reference. The threshold is 0.95 or "
            "more (Fig. 8). If each case held with probability q = 0.0625, at least as many would hold by chance with "
            "probability 0.001. This q is the share of the negative control, by the rule of succession, or one half. "
            "Rule and threshold are of revision 0123456789ab.")
        self.assertEqual(sentences.basis(claim("C13", "holds", rule="printed")), "")

    def test_when_threshold_and_rule_were_fixed_is_stated(self):
        judged = claim("C04", "holds", [case(1.0)] * 5, fixed_at="b" * 40, thresholds_fixed_at="a" * 40)
        self.assertIn("The threshold is of revision aaaaaaaaaaaa, the rule of revision bbbbbbbbbbbb.",
                      sentences.basis(judged))
        later = claim("C04", "fails", [case(0.5, False)], fixed_at="b" * 40, thresholds_fixed_at="a" * 40)
        told, = sentences.on_held_out_cases(judged | {"held_out": later})
        self.assertIn("recorded after the thresholds were fixed and before the rule was mended, the verdict is 'fails'",
                      told)

    def test_the_verdict_without_each_body(self):
        def told(**kinds):
            without = [{"body": body, "verdict": kind} for body, kind in kinds.items()]
            return sentences.without_a_body(claim("C04", "holds", without_body=without))

        self.assertEqual(told(), [])
        self.assertEqual(told(limb="holds", man="holds"), ["The verdict stays the same if any one body is excluded"])
        self.assertEqual(told(limb="holds", man="mixed"),
                         ["If one body is excluded, the verdict changes: it is 'mixed' without man"])
        self.assertEqual(told(limb="inconclusive", lady="mixed", man="inconclusive", ring="inconclusive"),
                         ["If one body is excluded, the verdict changes: it is 'inconclusive' without any one of limb, "
                          "man and ring and 'mixed' without lady"])

    def test_the_verdict_on_other_tets(self):
        def rows(name, held_out="", **kinds):
            return [{"claim": name, "size": size[1:].replace("_", "."), "human_vertices": "2115",
                     "limb_vertices": "1573", "verdict": kind, "held_out": held_out, "cases": "8", "holding": "1",
                     "least": "-6.959", "most": "7.6", "unit": "%"}
                    for size, kind in kinds.items()]

        def sentence(**kinds):
            return sentences.on_other_tets(claim("C01", "fails"), rows("C01", **kinds) + rows("C04", _1_10="holds"))

        meshes = ("On 2 other tet meshes of the human's and the limb's surfaces, with 0.90 to 1.10 times as many "
                  "vertices, the verdict")
        self.assertEqual(sentences.on_other_tets(claim("C13", "holds"), rows("C01", _0_90="fails")), [])
        self.assertEqual(sentence(_0_90="fails", _1_00="fails", _1_10="fails"), [f"{meshes} is the same"])
        self.assertEqual(sentence(_0_90="mixed", _1_00="fails", _1_10="fails"),
                         [f"{meshes} changes: it is 'mixed' on 1 of them"])
        self.assertEqual(sentence(_0_90="mixed", _1_10="holds"),
                         [f"{meshes} changes: it is 'mixed' on 1 and 'holds' on 1 of them"])
        later = claim("C01", "fails", held_out=claim("C01", "holds"))
        self.assertEqual(sentences.on_other_tets(later, rows("C01", held_out="holds", _0_90="fails", _1_10="fails")),
                         [f"{meshes} is the same, and that on the held-out cases is the same"])
        self.assertEqual(sentences.other_tets_rows(claim("C01", "fails"),
                                                   rows("C01", _0_90="not_shown") + rows("C04", _1_10="holds")),
                         [["0.90 times", "2115", "1573", "not shown", "\u2013", "1 of 8", "\u22126.96 to 7.6 %"]])

    def test_the_range_of_each_threshold(self):
        def told(low, high, **others):
            range_of = {"end": "high", "threshold": 1.05, "low": low, "high": high} | others
            return sentences.threshold_ranges(claim("C05", "holds", titles={"ratio": "radius"},
                                                    threshold_ranges=[range_of]))

        self.assertEqual(told(1.0468, 1.0642),
                         ["With any upper threshold from 1.047 to 1.064 in place of 1.05, the verdict is the same"])
        self.assertEqual(told(None, 2.0, end="low"),
                         ["With any lower threshold up to 2 in place of 1.05, the verdict is the same"])
        self.assertEqual(told(-1.0, None),
                         ["With any upper threshold from \u22121 on in place of 1.05, the verdict is the same"])
        self.assertEqual(told(None, None, quantity="ratio", precision="f64"),
                         ["With any upper threshold of the double precision, radius in place of 1.05, the verdict is "
                          "the same"])
        self.assertEqual(sentences.threshold_ranges(claim("C13", "holds")), [])

    def test_the_verdict_on_held_out_cases_stands_next_to_the_other(self):
        later = claim("C04", "fails", [case(0.5, False), case(1.0)], interval_low=0.01, interval_high=0.99)
        del later["titles"]  # claims.json has them once
        judged = claim("C04", "holds", [case(1.0)] * 5, held_out=later, titles={"ratio": "section radius"})
        self.assertEqual(sentences.both_verdicts(judged), "holds; on the held-out cases: fails")
        told, = sentences.on_held_out_cases(judged)
        self.assertIn("the verdict is 'fails'. 1 of 2 cases hold, share 0.5 [0.01, 0.99]. Section radius", told)
        self.assertEqual((sentences.both_verdicts(later), sentences.on_held_out_cases(later)), ("fails", []))
        self.assertEqual(sentences.both_verdicts(claim("C04", "holds", held_out=2)), "holds",
                         "older records count these cases")
        self.assertEqual(case_words.of({"body": "human", "motion": "range_of_motion",
                                        "pose": "elbow_flexion+supination"}),
                         "human, elbow flexion and supination")


class Compared(unittest.TestCase):
    def test_a_control_has_its_role_and_whether_it_behaves(self):
        controls = [selection("LBS", [case(0.5, False), case(1.0)], "negative_control"),
                    selection("LBS", (), "positive_control", False, quantities=["ms"])]
        self.assertEqual(sentences.control_rows(claim("C04", "holds", controls=controls)), [
            ["LBS", "negative control", "1 of 2 cases, share 0.5", "0.5 to 1", "yes"],
            ["LBS (ms)", "positive control", "no record", "", "no"]])

    def test_a_comparison_without_a_bound_counts_its_units_alone(self):
        compared = [selection("flesh, nu 0.45", [case(0.5, False)]), selection("XPBD", [case(1.0)], thresholds=[]),
                    selection("MLS")]
        self.assertEqual(sentences.compared_rows(claim("C04", "holds", compared=compared)), [
            ["flesh, nu 0.45", "0 of 1 case, share 0", "0.5"], ["XPBD", "1 case", "1"], ["MLS", "no record", ""]])

    def test_a_reading_has_its_least_and_most(self):
        readings = [selection("plain f32", [case(0.5, False), case(1.0)]), selection("")]
        self.assertEqual(sentences.reading_rows(claim("C04", "holds", readings=readings)), [
            ["plain f32", "1 of 2 cases, share 0.5", "0.5", "1"], ["not recorded", "no record", "", ""]])

    def test_a_reading_or_the_author_s_code_that_disagrees_is_named(self):
        holding, failing = ([case(value, holds, body=body) for body in "abcde"]
                            for value, holds in ((1.0, True), (0.5, False)))
        judged = claim("C04", "holds", holding, readings=[selection("plain f32", holding),
                                                          selection("ordered f32", failing)],
                       compared=[selection("DQS", failing),
                                 selection("the author's later code", failing[:2] + holding[2:])])
        told = sentences.disagreements(judged)
        self.assertEqual([text.split(" and ")[0] for text in told], ["Ordered f32", "The author's later code"])
        self.assertIn("the threshold holds in half of the cases or fewer in the one, throughout in the other", told[0])
        self.assertEqual(sentences.disagreements(claim("C04", "inconclusive",
                                                       readings=[selection("plain f32", holding)])), [])


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
        self.assertEqual({name for of in selected for name in of.get("quantities", [])} - document["quantity"].keys(),
                         set())


if __name__ == "__main__":
    unittest.main()
