"""The tables, pages and picture of the README and of the studies come from the records: the text between two markers is
written anew, the rest stays, and a README without the markers is refused; a run that disagrees with the records is
refused. Reference: the definition, the kept records, and tables made by hand."""
import csv
import json
import math
import shutil
import subprocess
import sys
import unittest
import unittest.mock

from results_case import ResultsTest, listening, root
import make_readme
import pages
import records
import synthetic_records
from drawing import style
from figures import work_precision as work_precision_figure
from pages import ambiguity, ensemble, short, work_precision
from readme import findings as readme_findings, pages as readme_pages, part as readme_part, tables as readme_tables
from readme import same_pose
from records import kept
from synthetic_records import case, claim, selection, write_origin, write_table

begin, end = readme_part.markers("claims")


class ReadmeTest(ResultsTest):
    def setUp(self):
        super().setUp()
        self.readme = self.results / "README.md"

    def written(self, name, lines_of, text=None):
        """Exit status and error messages of the script of this name for a README with `text`; by default the usual
        one."""
        self.readme.write_text(text if text is not None
                               else "before\n{}\nold\n{}\nafter\n".format(*readme_part.markers(name)))
        with listening() as (_, complaints):
            status = readme_part.main(name, lambda results: {self.readme: lines_of(results)}, self.results)
        return status, complaints.getvalue()


class ClaimPage(unittest.TestCase):
    def setUp(self):
        # The claims are made up, the meshes are not.
        patch = unittest.mock.patch.object(readme_pages, "meshes", lambda: [])
        patch.start()
        self.addCleanup(patch.stop)

    def test_a_claim_has_its_verdict_then_its_basis_then_a_table_for_each_kind_of_comparison(self):
        shown = claim("C04", "holds", [case(1.0)] * 5, titles={"ratio": "radius"}, interval_low=0.48, interval_high=1.0,
                      chance=0.001, q=0.2, controls=[selection("LBS", [case(0.5, False)], "negative_control")],
                      compared=[selection("DQS|2", [case(-0.4, False)])])
        self.assertEqual(readme_pages.claim_lines(shown), [
            "**C04: holds.** Volume is kept.", "", "5 of 5 cases hold, share 1 [0.48, 1]. Radius: 1, threshold 0.95 "
                                                   "or more.", "",
            "The number of a case (body) is the radius. The threshold is 0.95 or more (Sec. 4). If each case held with "
            "probability q = 0.2, at least as many would hold by chance with probability 0.001. This q is the "
            "share of the "
            "negative control, by the rule of succession, or one half.", "",
            "| control | role | cases that hold | numbers | as it must |", "|---|---|---|---|---|",
            "| LBS | negative control | 0 of 1 case, share 0 | 0.5 | yes |", "",
            "| for comparison | cases within the threshold | numbers |", "|---|---|---|",
            "| DQS\\|2 | 0 of 1 case, share 0 | -0.4 |"])

    def test_what_disagrees_in_the_same_cases_follows_the_tables(self):
        def last_line(bodies):
            wrong = [case(0.1, False, body=body) for body in bodies]
            return readme_pages.claim_lines(claim("C04", "holds", [case(1.0, body=body) for body in "abcdef"],
                                                  titles={}, readings=[selection("plain f32", wrong)]))[-1]

        self.assertRegex(last_line("abcde"), "^Plain f32 and the claim's own reading disagree: in the 5 cases that "
                                             "both have, ")
        for bodies in ("abcd", "abcdx"):  # fewer than five are no sample
            self.assertNotIn("disagree", last_line(bodies))

    def test_other_tets_have_a_sentence_and_a_table(self):
        row = {"claim": "C04", "size": "0.90", "human_vertices": "2115", "limb_vertices": "1573", "verdict": "fails",
               "held_out": "", "cases": "5", "holding": "2", "least": "0.5", "most": "1", "unit": "1"}
        with unittest.mock.patch.object(readme_pages, "meshes", lambda: [row]):
            lines = readme_pages.claim_lines(claim("C04", "holds", [case(1.0)] * 5, titles={"ratio": "radius"}))
        self.assertRegex("\n".join(lines), "On 1 other tet .*, the verdict changes: it is 'fails' on 1 of them")
        self.assertIn("| 0.90 times | 2115 | 1573 | fails | \u2013 | 2 of 5 | 0.5 to 1 |", lines)

    def test_a_page_begins_with_verdicts_that_differ(self):
        later = claim("C04", "fails", [case(0.5, False)],
                      controls=[selection("LBS", [case(0.5, False)], "negative_control")])
        first, *others = readme_pages.claim_page_lines([claim("C04", "holds", [case(1.0)] * 5, held_out=later)])
        self.assertEqual(first, "**C04 has two verdicts: holds; on the held-out cases: fails.**")
        self.assertIn("Controls on the held-out cases:", others)
        same = claim("C04", "holds", held_out=claim("C04", "holds"))
        self.assertNotIn("two verdicts", "".join(readme_pages.claim_page_lines([same])))

    def test_a_page_serves_both_halves_of_a_sentence(self):
        lines = readme_pages.claim_page_lines([claim("C02a", "fails", titles={}),
                                               claim("C02b", "inconclusive", titles={})])
        self.assertEqual([line.split(":")[0] for line in lines if line.startswith(("Study", "**"))],
                         ["Study", "**C02a", "**C02b"])


class Markers(ReadmeTest):
    def test_what_stands_between_is_replaced_and_nothing_else(self):
        self.assertEqual(self.written("claims", lambda folder: ["new", "", str(folder)]), (0, ""))
        self.assertEqual(self.readme.read_text(), f"before\n{begin}\nnew\n\n{self.results}\n{end}\nafter\n")
        self.assertEqual(readme_part.cut(self.readme, "claims")[1], f"\nnew\n\n{self.results}\n")
        self.assertEqual([path.name for path in self.results.iterdir()], ["README.md"])

    def test_a_readme_without_its_markers_in_order_is_refused_and_stays(self):
        for text, words in (("", f"{begin} occurs 0 times: expected once"),
                            (f"{end}", f"{begin} occurs 0 times"),
                            (f"{begin}\n", f"{end} occurs 0 times: expected once"),
                            (f"{begin}\n{begin}\n{end}", f"{begin} occurs 2 times"),
                            (f"{begin}\n{end}\n{end}", f"{end} occurs 2 times"),
                            (f"{end}\n{begin}", f"{end} precedes {begin}: expected after it"),
                            ("<!-- features:begin -->\n<!-- features:end -->", f"{begin} occurs 0 times")):
            with self.subTest(text):
                status, said = self.written("claims", lambda folder: ["new"], text)
                self.assertEqual(status, 2)
                self.assertIn(f"make_readme: claims: {self.readme}: {words}", said)
                self.assertEqual(self.readme.read_text(), text)

    def test_a_readme_that_is_not_there_is_refused(self):
        with self.refused("README.md: cannot be read"):
            readme_part.write(self.readme, "claims", ["new"])
        self.assertEqual(list(self.results.iterdir()), [])

    def test_refused_records_leave_readme_as_it_is(self):
        status, said = self.written("claims", readme_tables.claims_lines)
        self.assertEqual(status, 2)
        self.assertIn("claims.json: does not exist", said)
        self.assertIn("\nold\n", self.readme.read_text())

    def test_one_folder_is_asked_for(self):
        with listening() as (_, complaints):
            self.assertEqual([make_readme.main([]), make_readme.main(["folder", "no_such_part"])], [2, 2])
        self.assertIn("paper_figures/make_readme.py", complaints.getvalue())

    def test_the_projects_own_readme_has_each_pair_once(self):
        for name, page in (("claims", readme_part.own_readme), ("features", readme_tables.features_page),
                           ("reliability", readme_tables.reliability_page)):
            self.assertIn("\n| ", readme_part.cut(page, name)[1], name)


class Tables(ReadmeTest):
    def assert_written(self, name, lines_of, *lines):
        self.assertEqual(self.written(name, lines_of), (0, ""))
        text = self.readme.read_text()
        for line in lines:
            self.assertIn(line + "\n", text)
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n"))
        self.assertNotIn("\nold\n", text)

    def test_claims(self):
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        page = "experiments/verdicts/claims"
        self.assert_written("claims", readme_tables.claims_lines,
                            f"| [C02a]({page}/C02.md) | volume is kept | fails |  |  |",
                            f"| [C13]({page}/C13.md) | volume is kept | inconsistent in print |  |  |",
                            f"| [C14]({page}/C14.md) | volume is kept | inconclusive |  |  |",
                            f"\nMeasured at revision {synthetic_records.revision[:12]}.")

    def test_a_claim_has_its_short_texts_and_the_verdicts_on_held_out_cases_follow_in_one_sentence(self):
        claims = [claim(name, "holds", short="Volume", measured="in 8 clips", asked="all",
                        held_out=later and claim(name, later))
                  for name, later in (("C01", "fails"), ("C02a", "fails"), ("C03", "holds"), ("C04", None))]
        with unittest.mock.patch.object(readme_tables.sentences, "claims_of", lambda file: claims):
            (self.results / "claims.json").write_text("{}")
            self.assertEqual(readme_tables.claims_table(self.results)[2],
                             "| [C01](experiments/verdicts/claims/C01.md) | Volume | holds | in 8 clips | all |")
        self.assertEqual(readme_tables.held_out_sentences(claims),
                         ["On held-out cases, which were recorded after the thresholds were fixed, C01 and C02a fail; "
                          "C03 holds."])
        self.assertEqual(readme_tables.held_out_sentences(claims[3:]), [])

    def test_findings_without_the_values_that_they_state_are_refused(self):
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        status, said = self.written("findings", readme_findings.lines_of)
        self.assertEqual(status, 2)
        self.assertIn("claims.json: claims: 0 with the id C04: expected one", said)

    def test_the_volume_and_the_speed_are_ranges_over_the_cases(self):
        clips = [case(share, False, body="human", motion=clip) for clip, share in (("01_01", 0.36), ("01_03", 0.0))]
        self.assertEqual(readme_findings.volume([claim("C02a", "fails", clips)]),
                         "**Volume: not kept as claimed.** PBS is within the paper's limit in 0 to 36 % of the frames "
                         "of a clip.")
        self.assertEqual(readme_findings.speed([claim("C10a", "holds", [case(83.4), case(176.2)])]),
                         "**Speed: real time.** At the paper's sizes, one core computes 83 to 176 frames per second.")
        self.assertIn("stiffer", readme_findings.stiffness([claim("C11", "definition", [case(1.84), case(5.98)])]))

    def test_artefacts_are_counted_and_a_claim_without_cases_states_why(self):
        twist = case(0.067, False, body="limb", angle_deg=180.0)
        text = readme_findings.artefacts([claim("C04", "holds", [case(1.0)] * 28 + [twist]),
                                          claim("C05", "holds", [case(1.0)] * 5)])
        self.assertEqual(text, "**Artefacts: gone.** No candy wrapper of LBS is left in 28 of 29 poses, and no bulge "
                               "of DQS in 5 of 5 poses.")
        text = readme_findings.volume([claim("C02a", "inconclusive", why_inconclusive="too_few_cases")])
        self.assertIn("C02a is inconclusive. No case is on record.", text)

    def test_convergence_counts_the_cases(self):
        text = readme_findings.convergence([claim("C12a", "fails", [case(11.0)] * 2 + [case(61.0, False)])])
        self.assertEqual(text, "**Iterations: too few.** The paper's number suffices in 2 of 3 poses.")

    def test_bounded_or_diverged_is_not_at_rest(self):
        for diverged, title, rest in ((0.0, "never blows up", 60), (0.5, "blows up in 2 trials", 40)):
            rows = [{"quantity": f"share_of_cells_{what}", "deformer": deformer, "order": order, "precision": precision,
                     "value": value, "n": n}
                    for what, shares in (("diverged", (diverged, 0.0, 0.25, 0.5)),
                                         ("in_motion", (0.25, 0.5, 0.25, 0.5)))
                    for value, n, (order, precision) in zip(shares, (4, 6, 8, 8),
                                                            (("plain", "f64"), ("plain", "f64"), ("ordered", "f32"),
                                                             ("plain", "f32")))
                    for deformer in ("pbs", "xpbd")]
            write_table(self.results / "stability" / "pbs" / "measurements.csv", rows)
            self.assertEqual(readme_findings.stability(self.results),
                             f"**Stability: PBS {title}**, but it comes to rest in only {rest} % "
                             "of the trials with disturbances.")

    def test_the_distance_from_flesh_is_that_of_pbs_within_the_middle_time(self):
        synthetic_records.write_work_precision(self.results)
        self.assertEqual(readme_findings.distance(self.results), "**Distance from flesh: less than with LBS.** The "
                                                                 "skin of a body of 1.7 m is 6.8 mm from it with PBS, "
                                                                 "12 mm with LBS.")
        methods = self.results / "work_precision" / "methods.csv"
        write_table(methods, [row for row in records.read_rows(methods) if row["method"] != "pbs"])
        with self.refused("methods.csv: no row of PBS within 1 ms"):
            readme_findings.distance(self.results)

    def test_below_the_figure_are_the_answer_and_a_row_for_each_method(self):
        synthetic_records.write_work_precision(self.results)
        for run in (self.results / "work_precision").glob("*/run.json"):
            run.write_text(run.read_text().replace('"version"', '"cpu_model": "a processor", "version"'))
        picture = self.results / "error_against_time.png"
        with unittest.mock.patch.object(readme_findings, "picture", picture):
            shown, *lines = readme_findings.drawn_methods_lines(self.results)
        self.assertIn(picture.name, shown)
        self.assertTrue(lines[1].startswith("**With 1 ms per frame, "))
        self.assertIn("| method | takes | 0.1 ms | 1 ms | 10 ms |", lines)
        self.assertEqual(len([line for line in lines if line.startswith("|")]), 12)
        self.assertIn("| DQS | nothing | 86 [77, 103] a | 86 [77, 103] h | 86 [77, 103] h |", lines)
        self.assertIn("(a processor): geometric mean over 40 poses", " ".join(lines))
        self.assertLessEqual(max(len(line) for line in lines), 140)
        with open(picture.with_suffix(".csv"), newline="") as stream:
            drawn = list(csv.DictReader(stream))
        self.assertEqual({row["method"] for row in drawn if row["shown"] == "curve"}, set(synthetic_records.compared))

    def test_features(self):
        synthetic_records.write_study(self.results)
        folder = self.results / "timing" / "features_human"
        write_origin(folder, of="of_this_table")
        write_origin(self.results / "ambiguity" / "human", of="of_another_study")  # a study that comes first
        columns = {name + side: "1.5" for name in ("frame_cpu_ms", "start_s", "peak_mb")
                   for side in ("_without", "_with")}
        columns |= {"frame_cpu_ms_ratio" + part: "1.25" for part in ("", "_lower", "_upper")}
        columns |= {"feature": "sleep", "largest_distance_m": "0.002"}
        write_table(folder / "features.csv", [columns])
        self.assert_written("features", readme_tables.features_lines,
                            "| sleep | 1.50 | 1.50 | 1.25 [1.25, 1.25] | 1.50 | 1.50 | 2 | 2 | 2 mm |")
        self.assertEqual(readme_tables.features_lines(self.results)[-1], "Measured at revision of_this_tabl.")

    def test_reliability(self):
        told = self.results / "kills.json"
        record = {"name": "kills survived", "count": 19, "of": 20, "command": "kills.py",
                  "revision": "0123456789abcdef"}
        told.write_text(json.dumps(record))
        self.assert_written("reliability", readme_tables.reliability_lines,
                            "| kills survived | 19 of 20 | `kills.py` | 0123456789ab |")
        told.write_text("{}")
        status, said = self.written("reliability", readme_tables.reliability_lines)
        self.assertEqual(status, 2)
        self.assertIn("kills.json: name", said)


KEPT = root / "experiments" / "records" / "full"


class Pages(ResultsTest):
    def test_those_of_the_kept_records_are_current(self):
        opened = kept.opened(KEPT)
        composers = {study: compose for study, compose in pages.composers().items() if (KEPT / study).is_dir()}
        self.assertLessEqual({"ambiguity", "artefacts", "audit", "convergence", "jiggle", "stability", "timing"},
                             set(composers))
        for study, compose in composers.items():
            self.assertEqual((KEPT / study / f"{study}.md").read_text(encoding="utf-8"), compose(opened / study), study)

    def test_the_page_of_error_against_time_begins_with_the_answer(self):
        synthetic_records.write_work_precision(self.results)
        folder = self.results / "work_precision"
        synthetic_records.add_own_deformers(folder, {"mine": "own"})
        text = work_precision.page(folder)
        self.assertTrue(text.startswith("# Error against run time\n\n**mine leaves 50 % [40, 60] of the error of LBS "
                                        "in 8 ms per frame "))
        self.assertIn("**\n\n**With 1 ms per frame, quasi-Newton has the least error: ", text)
        self.assertIn("**\n\n- Within 0.1 ms per frame, DQS leaves 86 % of LBS's error (10 mm", text)
        for line in ("| neo-Hookean XPBD | material, springs, initial guess |  | 45 [40, 54] c\u2020 | 21 [19, "
                     "25] c\u2020 |  | "
                     "50 [45, 59] | 23 [21, 27] |",
                     "| PBS with smooth weights |  | 6.8 (2) | 5.6 (2) |  | 0.7 (\u00d7 1.4)\u2020 | 7 (\u00d7 "
                     "14)\u2020 |",
                     "A sign test over 5 bodies cannot have p below 0.0625,",
                     "| flesh known | 1 ms | 45 | 37 | 1 | 1 | 6 |",
                     "- flesh known, 1 ms: vertex block descent is nearer than quasi-Newton if bones hold the flesh as "
                     "rigid capsules.",
                     "## Decisions that change if a body is excluded: 4 of 212",
                     "| flesh known | 1 ms | LBS | PBS | PBS is nearer | without man: open |",
                     "| quasi-Newton | wrong material | 30 \u2192 60 | 30 \u2192 60 |",
                     "| 01_01 | rigid capsules | quasi-Newton |  | 48 % (5.8 mm) \u2192 24 % (2.9 mm) | ",
                     "at 0.1 to 1.4 % of the mean bone distance in 3 of 5 solutions, and at 1 % or less in 2. "
                     "Not reached: 1.",
                     "| vertex block descent |  | `vbd.iterations=1` | `vbd.iterations=10` |",
                     "- `mine`: the times that the program states"):
            self.assertIn(line, text)
        for study_word in ("undecided", "inconclusive"):
            self.assertNotIn(study_word, text)

    def test_the_quick_form_has_neither_clips_nor_other_starts(self):
        synthetic_records.write_work_precision(self.results)
        for name in ("motion.csv", "starts.csv"):
            (self.results / "work_precision" / name).unlink()
        text = work_precision.page(self.results / "work_precision")
        for heading in ("## Posed and played", "## What the initial guess"):
            self.assertNotIn(heading, text)

    def test_the_parts_of_the_error_of_pbs_begin_with_their_ranges(self):
        synthetic_records.write_error_split(self.results)
        (self.results / "plan.json").write_text(json.dumps({"runs": [{"name": "limb_twist_90"},
                                                                     {"name": "limb_bend_60"}]}))
        text = ensemble.page(self.results)
        self.assertIn("After 24 iterations in 2 poses, the solver is 1.25 % of the mean bone distance away from the "
                      "converged constraints. These are 20 % away from flesh, which is known within 5 %.", text)
        self.assertIn("| limb | bend | 60\u00b0 | neo-Hookean, bind | 9.0 | \u2013 |", text)
        self.assertIn("| limb | twist | 90\u00b0 | neo-Hookean, smooth, q 10, radius 0.7 | 9.0 | 20.0 |", text)

    def test_a_reading_shows_the_value_that_flips_or_changes_most(self):
        row = {"verdict_flips": "no", "a": "2", "b": "3", "change": "1", "b_over_a": "1.5"}
        flips = row | {"verdict_flips": "yes", "b_over_a": "1.1", "change": "0.2"}
        for shown, rows in (("x1.5", [row]), ("x1.1!", [row | {"b_over_a": "9"}, flips]),
                            ("x9", [row, row | {"b_over_a": "9"}]),
                            ("0>0.5!", [flips | {"a": "0", "b": "0.5", "b_over_a": ""}]),
                            ("", []),
                            ("-", [row | {"verdict_flips": "no_value", "a": "", "b": "", "change": "",
                                          "b_over_a": ""}]),
                            ("-!", [flips | {"b": "", "change": "", "b_over_a": ""}])):
            self.assertEqual(ambiguity.cell(rows), shown)

    def test_a_claim_states_which_readings_flip_it_and_why_others_have_no_value(self):
        rows = [{"body": "limb", "reading_b": name, "quantity": quantity, "verdict_flips": flips, "reason": reason}
                for name, quantity, flips, reason in (
                    ("B", "ratio", "yes", ""), ("C", "ratio", "no", ""), ("B", "share", "no_value", "four settings"),
                    ("B", "range", "no_value", "four settings"))]
        self.assertEqual(ambiguity.of_claim("C09", rows), "- C09: 1 of 2 values flip by limb, B\n"
                         "  - no value: four settings: share, range\n")

    def test_sections_are_counted_by_outcome_and_those_left_out_named(self):
        row = {"claim": "C05", "body": "human", "joint": "elbow", "remark": ""}
        text = short.of_sections([row | {"pose": "bend_45", "outcome": "measured"},
                                  row | {"pose": "bend_90", "outcome": "too_far"},
                                  row | {"pose": "crouch", "outcome": "measured", "remark": "pbs is wide"}])
        self.assertEqual(text, "- C05: 2 sections measured\n- C05: 1 sections too_far: human bend_90 elbow\n\n## "
                               "Remarks\n\n"
                         "- C05: human crouch elbow, measured: pbs is wide\n")

    def test_broken_initial_shapes_are_of_the_full_form_alone(self):
        study = self.results / "stability"
        write_table(study / "pbs" / "cells.csv", [{"body": "human", "model": "pbs", "factor": "k", "second_factor": "h",
                                                   "outcome": "kept"}])
        (study / "plan.json").write_text(json.dumps({"runs": [{"name": "pbs"}]}), encoding="utf-8")
        self.assertEqual([heading for heading, _ in short.stability(study)], ["Cells"])
        write_table(study / "pbs" / "starts.csv",
                    [{"body": "human", "model": "pbs", "pose": "crouch", "setting": "k", "setting_value": "1",
                      "outcome": "recovered"}])
        self.assertEqual([heading for heading, _ in short.stability(study)], ["Cells", "Broken initial shapes"])

    def test_a_study_without_records_has_no_page(self):
        self.assertEqual(pages.write(self.results), ([], 0))
        run = subprocess.run([sys.executable, "-B", root / "paper_figures/make_pages.py", self.results],
                             capture_output=True, text=True)
        self.assertEqual((run.returncode, run.stderr.splitlines()[-1].split(": ")[-1]),
                         (2, "no records of a study that has a page; run ./reproduce first"))
        (self.results / "ensemble").mkdir()
        (self.results / "ensemble" / "plan.json").write_text(json.dumps({"runs": []}), encoding="utf-8")
        self.assertEqual(pages.write(self.results), ([], 0), "its tables are missing")

    def test_a_damaged_table_is_refused_with_its_place(self):
        study = self.results / "ensemble"
        shutil.copytree(kept.opened(KEPT) / "ensemble", study)
        table = study / "limb_twist_90" / "attachments.csv"
        whole = table.read_text()
        head, line = whole.splitlines()[0], next(line for line in whole.splitlines() if ",0.2," in line)
        place, columns, cells = whole.splitlines().index(line) + 1, head.split(","), line.split(",")
        cells[columns.index("model_pct")] = "ten"
        for damaged, message in ((",".join(cells), f"attachments.csv:{place}: model_pct = ten: expected a number"),
                                 (line.rpartition(",")[0], f"attachments.csv:{place}: expected {len(columns)} cells"),
                                 (line + ",1", f"attachments.csv:{place}: expected {len(columns)} cells")):
            table.write_text(whole.replace(line, damaged, 1))
            with self.subTest(message), listening() as (_, complaints):
                self.assertEqual(pages.write(self.results), ([], 2))
                self.assertIn(message, complaints.getvalue())
        table.write_text(whole)
        self.assertEqual(pages.write(self.results), ([study / "ensemble.md"], 0))


def shown():
    with open(same_pose.picture.with_suffix(".csv"), newline="") as stream:
        return list(csv.DictReader(stream))


class ErrorAgainstTime(unittest.TestCase):
    def test_shows_the_kept_record(self):
        figure, rows = work_precision_figure.error_against_time(kept.opened(KEPT))
        style.pyplot.close(figure)
        with open(readme_findings.picture.with_suffix(".csv"), newline="") as stream:
            drawn = list(csv.DictReader(stream))
        self.assertEqual(len(drawn), len(rows))
        for shown, row in zip(drawn, rows):
            self.assertEqual(shown, {column: str(row.get(column) or "") for column in shown})


class SamePose(ResultsTest):
    def write_run(self, **changed):
        """The kept row of LBS in this frame as a run's metrics.csv, with these cells changed."""
        write_table(self.results / "metrics.csv", [{**same_pose.row_of(same_pose.kept_rows, "lbs"), **changed}])

    def test_each_method_is_shown_with_its_weights(self):
        self.assertEqual([(row["weights"], row["deformer"]) for row in shown()],
                         [(weights, deformer) for weights, deformer, _ in same_pose.panels])

    def test_the_numbers_are_those_of_the_records(self):
        for row in shown():
            self.assertEqual(float(row["time_s"]), same_pose.time_s)
            if row["weights"] != "Eq. 2":  # smooth weights are not in this record
                continue
            kept = same_pose.row_of(same_pose.kept_rows, row["deformer"])
            for column in same_pose.compared:
                self.assertTrue(math.isclose(float(row[column]), kept.number(column), rel_tol=1e-5), (row, column))

    def test_a_run_that_agrees_with_the_records_is_accepted_and_another_refused(self):
        self.write_run()
        self.assertEqual(same_pose.checked_row(self.results, "lbs")["deformer"], "lbs")
        self.write_run(volume_change_pct="-14.7")
        with self.refused("volume_change_pct of lbs = -14.7: expected -11.0"):
            same_pose.checked_row(self.results, "lbs")


if __name__ == "__main__":
    unittest.main()
