"""Reference: the definition. Records are read by name, errors name what is missing, and figures show the records' values and their
origin."""
import json
import unittest

from results_case import ResultsTest
import make_all
import records
import synthetic_records
from figures import timing


class Figures(ResultsTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)
        self.twist = self.results / "volume" / "limb_twist"

    def test_select_tells_iterations_and_variants_apart(self):
        run = records.Run(self.twist)
        self.assertEqual(records.numbers(run.select("pbs", 24), "volume_change_pct")[-1], -180 / 1000 / 24)
        self.assertEqual(len(run.select("pbs", 24, "jiggle")), 37)
        self.assertEqual(run.pbs_iterations(), [1, 24, 96])
        self.assertEqual(run.reference(), "fem_p2")

    def test_at_angle(self):
        rows = records.Run(self.twist).select("lbs")
        self.assertEqual(records.numbers([records.at_angle(rows, 90)], "volume_change_pct"), [-9.0])
        with self.refused("no frame at 91 degrees"):
            records.at_angle(rows, 91)

    def test_missing_records_are_named(self):
        run, human = records.Run(self.twist), self.results / "volume" / "human_01_01"
        clip = records.Run(human)
        (self.results / "volume" / "limb_bend" / "run.json").write_text("{")
        (human / "frame_statistics.csv").rename(human / "kept.csv")
        for words, action in (
                ("no rows of deformer pbs, variant default, 7 iterations", lambda: run.select("pbs", 7)),
                ("no column colour", lambda: records.numbers(run.select("lbs"), "colour")),
                ("column angle_deg is empty", lambda: records.numbers(clip.select("lbs"), "angle_deg")),
                ("run.json:1: not JSON", lambda: records.Run(self.results / "volume" / "limb_bend")),
                ("run.json: does not exist", lambda: records.Run(self.results / "volume")),
                ("of an earlier version and has to be made again", lambda: clip.statistics("pbs", 24))):
            with self.subTest(words), self.refused(words):
                action()

    def test_curves_are_drawn_with_their_source_and_numbers(self):
        old = self.results / "figures" / "old.png"
        old.parent.mkdir()
        old.touch()
        said, complaints = self.make_all()
        self.assertEqual(complaints, "")
        self.assertIn("verification left out: the study verification was not run", said)
        self.assertFalse(old.exists())
        for name in ("volume_over_angle", "volume_over_clip", "volume_over_iterations"):
            for ending in ("png", "pdf"):
                self.assertIn(synthetic_records.revision.encode(), (self.results / "figures" / f"{name}.{ending}").read_bytes())
        rows = [row for row in self.rows("volume_over_angle") if row["deformer"] == "lbs" and row["scene"] == "limb_twist"]
        self.assertEqual([float(row["volume_change_pct"]) for row in rows], [-angle / 10 for angle in range(0, 181, 5)])
        signed = [row for row in self.rows("volume_over_iterations")
                  if row["pose"] == "all frames" and row["measure"] == "volume_change_pct"]
        self.assertEqual([(row["iterations"], row["q10"], row["median"], row["q90"]) for row in signed],
                         [(count, "-3.0", "-2.0", "-1.0") for count in ("1", "24", "96")])  # from the record, not computed from the rows
        with self.assertRaises(SystemExit):
            make_all.main(self.results / "figures")

    def test_order_statistics_are_of_one_setting(self):
        human = records.Run(self.results / "volume" / "human_01_01")
        with self.refused("3 rows of deformer pbs, variant default, expected one"):
            human.statistics("pbs")
        with self.refused("0 rows of deformer pbs, variant jiggle, 24 iterations, expected one"):
            human.statistics("pbs", 24, "jiggle")


class OtherStudies(ResultsTest):
    def test_figures_of_records_that_are_gone_are_deleted(self):
        figures = self.results / "figures"
        figures.mkdir()
        for name in ("work_precision.svg", "work_precision.csv", "somebody's.svg"):
            (figures / name).write_text("")
        with self.assertRaisesRegex(SystemExit, "no study in it"):
            make_all.main(self.results)
        self.assertEqual([path.name for path in figures.iterdir()], ["somebody's.svg"])

    def test_verification_shows_the_finest_mesh_of_each_benchmark(self):
        synthetic_records.write_verification(self.results)
        rows = [row for row in self.drawn("verification") if row["problem"] == "cantilever"]
        self.assertEqual([(row["element_order"], float(row["difference_pct"])) for row in rows], [("1", -10.0), ("2", -0.625)])
        self.refused_without("verification/verification.csv")

    def test_the_fit_shows_moduli_with_volume_constraints_alone(self):
        synthetic_records.write_fit(self.results)
        young = {(row["of"], float(row["at"])): float(row["value"]) for row in self.drawn("fit") if row["shown"] == "young_kpa"}
        self.assertEqual(len(young), 6)
        self.assertAlmostEqual(young["300 vertices, 24 iterations", 0.2], 480.0)
        self.refused_without("fit/sag.csv")

    def test_work_precision_shows_each_comparison_with_its_nearest_and_its_omissions(self):
        synthetic_records.write_work_precision(self.results)
        lbs = ("lbs", 0.1, 50.0)
        for name, ms in (("work_precision", 1.0), ("work_precision_plain", 5.0)):
            rows = self.drawn(name)
            self.assertEqual({row["panel"] for row in rows}, {"limb, bend 90\u00b0"})  # not the pose that trains
            found = {shown: [(row["deformer"], float(row["ms_median"] or 0), float(row["error_joint_pct"] or 0)) for row in rows
                             if row["shown"] == shown] for shown in {row["shown"]: 0 for row in rows}}
            pbs = [("pbs", ms, 40.0), ("pbs", 2 * ms, 20.0), ("pbs", 4 * ms, 10.0)]
            nearest = [("", 0.1, 50.0), ("", 1.0, 40.0) if ms == 1.0 else ("", 0.1, 50.0), ("", 4 * ms, 10.0)]
            expected = {"point": [lbs, *pbs], "front of all": [lbs, *pbs], "front of lbs": [lbs], "front of pbs": pbs,
                        "nearest": nearest, "bound": [("", 0.0, 15.0)]}
            self.assertEqual(found, expected | ({"omission": [("xpbd", 0.0, 0.0)]} if ms == 1.0 else {}))
        drawn = (self.results / "figures" / "work_precision.svg").read_text()
        # a question mark: not decided against one group
        for text in ("0.1 ms:", "LBS", "PBS? (1)", "diverged: XPBD 2 of 9", "reference 90 s, bound 15 %",
                     "Not decided:", "within 10 ms against: LBS"):
            self.assertIn(text, drawn)
        self.assertNotIn("diverged", (self.results / "figures" / "work_precision_plain.svg").read_text())
        profiles = self.drawn("data_profiles")
        self.assertEqual([(row["comparison"], row["ms"]) for row in profiles if row["ms"]], [("packed_f32", "4.0"), ("plain_f64", "20.0")])
        self.assertEqual([row["omission"] for row in profiles if row["comparison"] == "packed_f32" and row["omission"]],
                         ["diverged: XPBD 2 of 9", "no pose solved to 10 %: LBS", "no pose solved to 5 %: LBS, PBS",
                          "no pose solved to 2 %: LBS, PBS"])
        self.refused_without("work_precision/fronts.csv", "work_precision")

    def test_work_precision_shows_deformers_of_the_users_own_with_their_clocks(self):
        synthetic_records.write_work_precision(self.results)
        synthetic_records.add_own_deformers(self.results / "work_precision", {"mine": "own", "other_one": "wall", "linked": "processor"})
        for name in ("work_precision", "work_precision_plain"):
            found = [(row["shown"], row["deformer"], float(row["ms_median"] or 0)) for row in self.drawn(name)]
            for shown in ("point", "front of mine"):
                self.assertIn((shown, "mine", 8.0), found)
            drawn = (self.results / "figures" / f"{name}.svg").read_text()
            for text in ("mine: time as the program states it", "other_one: wall time of the program", ">linked<"):
                self.assertIn(text, drawn)
            for words in ("time", "wall"):
                self.assertNotIn(f"linked: {words}", drawn)

    def test_the_bench_shows_cost_a_constraint(self):
        synthetic_records.write_bench(self.results)
        rows = self.drawn("scaling")
        cost = {(row["order"], row["precision"], row["tets"]): row for row in rows if row["shown"] == "ns_per_constraint"}
        self.assertEqual(len(cost), 8)
        plain = cost["plain", "f32", "400"]  # 24 us per constraint and step of 24 iterations
        for column, expected in (("value", 1000.0), ("low", 900.0), ("high", 1100.0)):
            self.assertAlmostEqual(float(plain[column]), expected)
        self.assertAlmostEqual(float(cost["ordered", "f64", "5000"]["value"]), 250.0)
        self.assertEqual({row["value"] for row in rows if row["shown"] == "speedup_by_threads"}, {"1.5"})
        fits = [(row["order"], row["precision"], row["value"], row["low"]) for row in rows if row["shown"] == "exponent"]
        self.assertEqual(fits, [("ordered", "f32", "1.0", "")])
        bench = self.results / "timing" / "bench" / "bench.json"
        bench.write_text(json.dumps(json.loads(bench.read_text()) | {"schema": 1}))
        with self.refused("schema 1, expected 2"):
            timing.read_bench(bench)
        self.refused_without("timing/bench/bench.json", "scaling")


if __name__ == "__main__":
    unittest.main()
