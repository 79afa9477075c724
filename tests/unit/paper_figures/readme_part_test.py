"""The tables of the README come from the records: the text between two markers is written anew, the rest stays, and a README without the
markers is refused. Reference: the definition."""
import json
import unittest

from results_case import ResultsTest, listening
import make_readme
import synthetic_records
from readme import findings as readme_findings, pages as readme_pages, part as readme_part, tables as readme_tables
from synthetic_records import claim, interval, judged_run, value, write_origin, write_table

begin, end = readme_part.markers("claims")


class ReadmeTest(ResultsTest):
    def setUp(self):
        super().setUp()
        self.readme = self.results / "README.md"

    def written(self, name, lines_of, text=None):
        """Exit status and error messages of the script of this name for a README with `text`; by default the usual one."""
        self.readme.write_text(text if text is not None else "before\n{}\nold\n{}\nafter\n".format(*readme_part.markers(name)))
        with listening() as (_, complaints):
            status = readme_part.main(name, lambda results: {self.readme: lines_of(results)}, self.results)
        return status, complaints.getvalue()


class ComparedResults(unittest.TestCase):
    table = ["", "For comparison, the tables show other deformers and finite elements under the same bounds. "
                 "They are no part of the verdict.", ""]

    def test_frames_of_all_runs_are_counted(self):
        runs = [judged_run(body, "walk", "part", interval(-0.2), interval(share)) | {"deformer": deformer}
                for body, share, deformer in (("man", 0.9, "nh_p1"), ("lady", 0.1, "nh_p1"), ("man", 0.5, "pbs"))]
        shown = claim("C02", "not_reproduced", titles={"volume_change_pct": "volume change"}, controls=runs,
                      bounds=[{"quantity": "volume_change_pct", "low": -0.5, "high": 0.5}])
        self.assertEqual(readme_pages.compared_lines(shown, "pbs"),
                         [*self.table, "| deformer | volume change | within the bound |", "|---|---|---|",
                          "| neo-Hookean FEM, linear elements | -0.9 to 0 % | 50 of 100 frames in 2 runs |"])
        self.assertEqual(readme_pages.compared_lines(shown, None), [])

    def test_values_are_compared_with_each_end_of_the_bound(self):
        values = [value("ratio", number, deformer="dqs") for number in (0.5, 0.9, 1.2)] + [value("ratio", None, deformer="dqs")]
        for low, high, held in ((0.9, None, 2), (None, 0.9, 2), (0.6, 1.0, 1), (2.0, None, 0)):
            shown = claim("C04", "not_reproduced", titles={}, controls=values, bounds=[{"quantity": "ratio", "low": low, "high": high}])
            self.assertEqual(readme_pages.compared_lines(shown, "pbs")[-1], f"| DQS | 0.5 to 1.2 | {held} of 3 values |")

    def test_a_claim_on_orders_of_a_deformer_has_no_table(self):
        self.assertEqual([readme_pages.own_deformer(claim) for claim in
                          ({"of": {"deformer": "pbs"}}, {"of": {"deformer": "pbs", "order": "plain"}}, {"deformer": "lbs"}, {})],
                         ["pbs", None, "lbs", None])


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
            self.assertTrue(readme_part.cut(page, name)[1].startswith("\n| "), name)


class Tables(ReadmeTest):
    def assert_written(self, name, lines_of, *lines):
        self.assertEqual(self.written(name, lines_of), (0, ""))
        text = self.readme.read_text()
        for line in lines:
            self.assertIn(line + "\n", text)
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n"))
        self.assertNotIn("old", text)

    def test_claims(self):
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        self.assert_written("claims", readme_tables.claims_lines,
                            "| Volume is kept. (Sec. 4) | reproduced in part | 1 of 3 within; share of frames 40 [30, 50] % "
                            "(human, clip walk), expected 95 to 100 % | [C02](experiments/verdicts/claims/C02.md) |",
                            "| 2 of 2 within; frames per second 107 [100, 110] 1/s (frankie), expected 30 or more "
                            "| [C10](experiments/verdicts/claims/C10.md) |",
                            "| 1 of 2 values consistent | [C13](experiments/verdicts/claims/C13.md) |",
                            f"\nMeasured at revision {synthetic_records.revision[:12]}.")

    def test_findings_without_the_values_that_they_state_are_refused(self):
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        status, said = self.written("findings", readme_findings.lines_of)
        self.assertEqual(status, 2)
        self.assertRegex(said, r"claims.json: claims: 0 with .*C04.*: expected one")

    def write_ensemble(self, difference_pct="3", landing_bound="0.1"):
        """Two poses, two references, of which the first is reported; LBS is 4 and 6 % away, PBS 1 and 3 %. The bound on the first
        reference's own error may be missing in the second pose."""
        study = self.results / "ensemble"
        for pose, far, bound in (("crouch", 0, "0.1"), ("landing", 2, landing_bound)):
            write_table(study / pose / "members.csv", [{"member": "smooth", "error_bound_pct": bound}, {"member": "stiffer"}])
            write_table(study / pose / "errors.csv", [
                {"body": "human", "pose": pose, "angle_deg": "", "member": member, "deformer": name, "error_joint_pct": error + far + more}
                for member, more in (("smooth", 0), ("stiffer", 10))
                for name, error in (("lbs", 4), ("dqs", 3), ("delta_mush", 2), ("pbs", 1))])
        write_table(study / "pairs.csv", [
            {"first": first, "second": second, "largest_difference_pct": points, "members": 2, "decision": decision}
            for first, second, points, decision in (
                ("lbs", "pbs", difference_pct, "decided"), ("dqs", "pbs", difference_pct, "reference_error"),
                ("delta_mush", "pbs", difference_pct, "reference_error"), ("delta_mush", "dqs", difference_pct, "models_disagree"),
                ("lbs", "dqs", 1, "decided"), ("fem_linear", "lbs", 9, "decided"))])

    def test_the_distance_from_flesh_is_that_of_the_first_reference(self):
        self.write_ensemble()
        text = readme_findings.distance(self.results)
        self.assertIn("In 2 poses of the limb and the human, PBS with 24 iterations is 1.0 to 3.0 % of", text)
        self.assertIn("(LBS 4.0 to 6.0 %, DQS 3.0 to 5.0 %, delta mush 2.0 to 4.0 %)", text)
        self.assertIn("In all 2 poses, 2 references with", text)
        self.assertIn("decide which of two methods is closer in 1 of the 4 pairs of skinning methods that differ by more than 2", text)
        self.assertIn("in 2 the own error of a reference is too large or not known and in 1 the references disagree.", text)
        self.assertNotIn("leave out", text)

    def test_the_distance_leaves_out_poses_whose_reference_has_no_bound(self):
        self.write_ensemble(landing_bound="")
        text = readme_findings.distance(self.results)
        self.assertIn("In 1 pose of the limb and the human, PBS with 24 iterations is 1.0 to 1.0 % of", text)
        self.assertIn("These errors leave out 1 pose in which the reference has no bound on its own error. In all 2 poses, 2", text)

    def test_the_distance_needs_pairs_that_differ(self):
        self.write_ensemble(difference_pct="1.9")
        with self.refused("or no pair of them"):
            readme_findings.distance(self.results)

    def test_features(self):
        synthetic_records.write_study(self.results)
        folder = self.results / "timing" / "features_human"
        write_origin(folder, of="of_this_table")
        write_origin(self.results / "ambiguity" / "human", of="of_another_study")  # a study that comes first
        columns = {name + side: "1.5" for name in ("frame_cpu_ms", "start_s", "peak_mb") for side in ("_without", "_with")}
        columns |= {"frame_cpu_ms_ratio" + part: "1.25" for part in ("", "_lower", "_upper")}
        columns |= {"feature": "sleep", "largest_distance_m": "0.002"}
        write_table(folder / "features.csv", [columns])
        self.assert_written("features", readme_tables.features_lines,
                            "| sleep | 1.50 | 1.50 | 1.25 [1.25, 1.25] | 1.50 | 1.50 | 2 | 2 | 2 mm |")
        self.assertEqual(readme_tables.features_lines(self.results)[-1], "Measured at revision of_this_tabl.")

    def test_reliability(self):
        told = self.results / "kills.json"
        record = {"name": "kills survived", "count": 19, "of": 20, "command": "kills.py", "revision": "0123456789abcdef"}
        told.write_text(json.dumps(record))
        self.assert_written("reliability", readme_tables.reliability_lines, "| kills survived | 19 of 20 | `kills.py` | 0123456789ab |")
        told.write_text("{}")
        status, said = self.written("reliability", readme_tables.reliability_lines)
        self.assertEqual(status, 2)
        self.assertIn("kills.json: name", said)


if __name__ == "__main__":
    unittest.main()
