"""Reference: the definition. Records are read by name, errors name what is missing, and figures show the records' values and their
origin."""
import contextlib
import csv
import io
import json
import pathlib
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(root / "paper_figures"), str(pathlib.Path(__file__).parent)]

import checked_looks  # noqa: E402,F401
import make_all  # noqa: E402
import records  # noqa: E402
import synthetic_records  # noqa: E402
from figures import timing  # noqa: E402


class Figures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)
        synthetic_records.write_study(self.results)
        self.twist = self.results / "volume" / "limb_twist"

    def assert_missing(self, expected, action):
        with self.assertRaises(records.RecordsMissing) as caught:
            action()
        self.assertIn(expected, str(caught.exception))

    def test_select_tells_iterations_and_variants_apart(self):
        run = records.Run(self.twist)
        self.assertEqual(records.numbers(run.select("pbs", 24), "volume_change_pct")[-1], -180 / 1000 / 24)
        self.assertEqual(len(run.select("pbs", 24, "jiggle")), 37)
        self.assertEqual(run.pbs_iterations(), [1, 24, 96])
        self.assertEqual(run.reference(), "fem_p2")

    def test_at_angle(self):
        rows = records.Run(self.twist).select("lbs")
        self.assertEqual(records.numbers([records.at_angle(rows, 90)], "volume_change_pct"), [-9.0])
        self.assert_missing("no frame at 91 degrees", lambda: records.at_angle(rows, 91))

    def test_missing_records_are_named(self):
        run = records.Run(self.twist)
        self.assert_missing("no rows of deformer pbs, variant default, 7 iterations", lambda: run.select("pbs", 7))
        self.assert_missing("no column colour", lambda: records.numbers(run.select("lbs"), "colour"))
        clip = records.Run(self.results / "volume" / "human_01_01")
        self.assert_missing("column angle_deg is empty", lambda: records.numbers(clip.select("lbs"), "angle_deg"))
        (self.twist / "run.json").write_text("{")
        self.assert_missing("run.json:1: not JSON", lambda: records.Run(self.twist))
        (self.twist / "run.json").unlink()
        self.assert_missing("run.json: does not exist", lambda: records.Run(self.twist))

    def test_curves_are_drawn_with_their_source_and_numbers(self):
        old = self.results / "figures" / "old.png"
        old.parent.mkdir()
        old.touch()
        said = io.StringIO()
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
            status = make_all.main(self.results)
        self.assertEqual((status, said.getvalue()), (0, ""))
        self.assertFalse(old.exists())
        for name in ("volume_over_angle", "volume_over_clip", "volume_over_iterations"):
            for ending in ("png", "pdf"):
                self.assertIn(synthetic_records.revision.encode(), (self.results / "figures" / f"{name}.{ending}").read_bytes())
        with open(self.results / "figures" / "volume_over_angle.csv", newline="") as stream:
            rows = [row for row in csv.DictReader(stream) if row["deformer"] == "lbs" and row["scene"] == "limb_twist"]
        self.assertEqual([float(row["volume_change_pct"]) for row in rows], [-angle / 10 for angle in range(0, 181, 5)])
        with open(self.results / "figures" / "volume_over_iterations.csv", newline="") as stream:
            signed = [row for row in csv.DictReader(stream) if row["pose"] == "all frames" and row["measure"] == "volume_change_pct"]
        self.assertEqual([(row["iterations"], row["q10"], row["median"], row["q90"]) for row in signed],
                         [(count, "-3.0", "-2.0", "-1.0") for count in ("1", "24", "96")])  # from the record, not computed from the rows

    def test_a_run_of_an_earlier_version_has_no_order_statistics(self):
        human = self.results / "volume" / "human_01_01"
        (human / "frame_statistics.csv").unlink()
        self.assert_missing("of an earlier version and has to be made again", lambda: records.Run(human).statistics("pbs", 24))

    def test_order_statistics_are_of_one_setting(self):
        human = records.Run(self.results / "volume" / "human_01_01")
        self.assert_missing("3 rows of deformer pbs, variant default, expected one", lambda: human.statistics("pbs"))
        self.assert_missing("0 rows of deformer pbs, variant jiggle, 24 iterations, expected one",
                            lambda: human.statistics("pbs", 24, "jiggle"))

    def test_a_study_that_was_not_run_is_left_out(self):
        said = io.StringIO()
        with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(said):
            make_all.main(self.results)
        self.assertIn("verification left out: the study verification was not run", said.getvalue())
        with self.assertRaises(SystemExit):
            make_all.main(self.results / "figures")

    def test_figures_of_records_that_are_gone_are_deleted(self):
        with tempfile.TemporaryDirectory() as scratch:
            figures = pathlib.Path(scratch, "figures")
            figures.mkdir()
            for name in ("work_precision.svg", "work_precision.csv", "somebody's.svg"):
                (figures / name).write_text("")
            with self.assertRaisesRegex(SystemExit, "no study in it"):
                make_all.main(pathlib.Path(scratch))
            self.assertEqual([path.name for path in figures.iterdir()], ["somebody's.svg"])

    def test_verification_shows_the_finest_mesh_of_each_benchmark(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder)
            synthetic_records.write_verification(results)
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(make_all.main(results), 0)
            self.assertIn(synthetic_records.revision.encode(), (results / "figures" / "verification.png").read_bytes())
            with open(results / "figures" / "verification.csv", newline="") as stream:
                rows = [row for row in csv.DictReader(stream) if row["problem"] == "cantilever"]
            self.assertEqual([(row["element_order"], float(row["difference_pct"])) for row in rows], [("1", -10.0), ("2", -0.625)])
            (results / "verification" / "verification.csv").unlink()
            with contextlib.redirect_stderr(io.StringIO()) as said:
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(make_all.main(results), 1)
            self.assertIn("verification.csv: does not exist", said.getvalue())

    def test_the_fit_shows_moduli_with_volume_constraints_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder)
            synthetic_records.write_fit(results)
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(make_all.main(results), 0)
            self.assertIn(synthetic_records.revision.encode(), (results / "figures" / "fit.png").read_bytes())
            with open(results / "figures" / "fit.csv", newline="") as stream:
                rows = list(csv.DictReader(stream))
            young = {(row["of"], float(row["at"])): float(row["value"]) for row in rows if row["shown"] == "young_kpa"}
            self.assertEqual(len(young), 6)
            self.assertAlmostEqual(young["300 vertices, 24 iterations", 0.2], 480.0)
            (results / "fit" / "sag.csv").unlink()
            with contextlib.redirect_stderr(io.StringIO()) as said:
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(make_all.main(results), 1)
            self.assertIn("sag.csv: does not exist", said.getvalue())

    def test_work_precision_shows_each_comparison_with_its_nearest_and_its_omissions(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder)
            synthetic_records.write_work_precision(results)
            for name in ("work_precision", "work_precision_plain", "data_profiles"):
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(make_all.main(results, name), 0)
            lbs = ("lbs", 0.1, 50.0)
            for name, ms in (("work_precision", 1.0), ("work_precision_plain", 5.0)):
                self.assertIn(synthetic_records.revision.encode(), (results / "figures" / f"{name}.png").read_bytes())
                rows = records.read_rows(results / "figures" / f"{name}.csv")
                self.assertEqual({row["panel"] for row in rows}, {"limb, bend 90\u00b0"})  # not the pose that trains
                found = {shown: [(row["deformer"], float(row["ms_median"] or 0), float(row["error_joint_pct"] or 0)) for row in rows
                                 if row["shown"] == shown] for shown in {row["shown"]: 0 for row in rows}}
                pbs = [("pbs", ms, 40.0), ("pbs", 2 * ms, 20.0), ("pbs", 4 * ms, 10.0)]
                nearest = [("", 0.1, 50.0), ("", 1.0, 40.0) if ms == 1.0 else ("", 0.1, 50.0), ("", 4 * ms, 10.0)]
                expected = {"point": [lbs, *pbs], "front of all": [lbs, *pbs], "front of lbs": [lbs], "front of pbs": pbs,
                            "nearest": nearest, "bound": [("", 0.0, 15.0)]}
                self.assertEqual(found, expected | ({"omission": [("xpbd", 0.0, 0.0)]} if ms == 1.0 else {}))
            drawn = (results / "figures" / "work_precision.svg").read_text()
            # a question mark: not decided against one group
            for text in ("0.1 ms:", "LBS", "PBS? (1)", "diverged: XPBD 2 of 9", "reference 90 s, bound 15 %",
                         "Not decided:", "within 10 ms against: LBS"):
                self.assertIn(text, drawn)
            self.assertNotIn("diverged", (results / "figures" / "work_precision_plain.svg").read_text())
            profiles = records.read_rows(results / "figures" / "data_profiles.csv")
            self.assertEqual([(row["comparison"], row["ms"]) for row in profiles if row["ms"]],
                             [("packed_f32", "4.0"), ("plain_f64", "20.0")])
            omitted = [row["omission"] for row in profiles if row["comparison"] == "packed_f32" and row["omission"]]
            self.assertEqual(omitted, ["diverged: XPBD 2 of 9", "no pose solved to 10 %: LBS", "no pose solved to 5 %: LBS, PBS",
                                       "no pose solved to 2 %: LBS, PBS"])
            (results / "work_precision" / "fronts.csv").unlink()
            with contextlib.redirect_stderr(io.StringIO()) as said:
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(make_all.main(results, "work_precision"), 1)
            self.assertIn("fronts.csv: does not exist", said.getvalue())

    def test_work_precision_shows_deformers_of_the_users_own_with_their_clocks(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder)
            synthetic_records.write_work_precision(results)
            synthetic_records.add_own_deformers(results / "work_precision", {"mine": "own", "other_one": "wall", "linked": "processor"})
            for name in ("work_precision", "work_precision_plain"):
                with contextlib.redirect_stdout(io.StringIO()):
                    self.assertEqual(make_all.main(results, name), 0)
                rows = records.read_rows(results / "figures" / f"{name}.csv")
                for shown in ("point", "front of mine"):
                    self.assertIn((shown, "mine", 8.0), [(row["shown"], row["deformer"], float(row["ms_median"] or 0)) for row in rows])
                drawn = (results / "figures" / f"{name}.svg").read_text()
                for text in ("mine: time as the program states it", "other_one: wall time of the program", ">linked<"):
                    self.assertIn(text, drawn)
                for words in ("time", "wall"):
                    self.assertNotIn(f"linked: {words}", drawn)

    def test_the_bench_shows_cost_a_constraint(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder)
            synthetic_records.write_bench(results)
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(make_all.main(results, "scaling"), 0)
            self.assertIn(synthetic_records.revision.encode(), (results / "figures" / "scaling.png").read_bytes())
            with open(results / "figures" / "scaling.csv", newline="") as stream:
                rows = list(csv.DictReader(stream))
            cost = {(row["order"], row["precision"], row["tets"]): float(row["value"]) for row in rows
                    if row["shown"] == "ns_per_constraint"}
            self.assertEqual(len(cost), 8)
            self.assertAlmostEqual(cost["plain", "f32", "400"], 1000.0)  # 24 us per constraint and step of 24 iterations
            self.assertAlmostEqual(cost["ordered", "f64", "5000"], 250.0)
            self.assertEqual({row["value"] for row in rows if row["shown"] == "speedup_by_threads"}, {"1.5"})
            band = next(row for row in rows if (row["order"], row["precision"], row["tets"]) == ("plain", "f32", "400"))
            self.assertAlmostEqual(float(band["low"]), 900.0)
            self.assertAlmostEqual(float(band["high"]), 1100.0)
            fits = [(row["order"], row["precision"], row["value"], row["low"]) for row in rows if row["shown"] == "exponent"]
            self.assertEqual(fits, [("ordered", "f32", "1.0", "")])
            bench = results / "timing" / "bench" / "bench.json"
            bench.write_text(json.dumps(json.loads(bench.read_text()) | {"schema": 1}))
            with self.assertRaisesRegex(records.RecordsMissing, "schema 1, expected 2"):
                timing.read_bench(bench)
            bench.unlink()
            with contextlib.redirect_stderr(io.StringIO()) as said:
                self.assertEqual(make_all.main(results, "scaling"), 1)
            self.assertIn("bench.json: does not exist", said.getvalue())


if __name__ == "__main__":
    unittest.main()
