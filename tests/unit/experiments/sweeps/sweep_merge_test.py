"""Reference: the definition, for runs whose metrics are known. The table does not depend on the order, the times or the machine of the
runs. A run that is missing or incomplete is an error, which leaves the previous table."""
import csv
import json
import pathlib
import random
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[4]
sys.path[:0] = [str(root / "experiments/sweeps"), str(pathlib.Path(__file__).parent)]

import sweep_file  # noqa: E402
import sweep_merge  # noqa: E402
import synthetic_runs  # noqa: E402

SWEEP = 'schema = 1\nscene = "limb_bend"\n[grid]\nmotion.joint = ["a", "b"]\npbs.iterations = [3, 1, 2]\n'
OUTCOME = {"schema": 1, "exit_status": 0, "message": "", "seconds": 1.0, "cpu_seconds": 0.5, "files": 3, "stored_bytes": 4096}


class SweepMerge(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.sweep = self.read(SWEEP)

    def read(self, text):
        (self.folder / "sweep.toml").write_text(text)
        return sweep_file.read(self.folder / "sweep.toml")

    def write_runs(self, out, sweep, seed=1, **changes):
        shuffled = random.Random(seed)
        for run in shuffled.sample(sweep.runs, len(sweep.runs)):
            place = out / "runs" / run.name
            synthetic_runs.write(place, int(run.varied["pbs.iterations"]), **{"step_ms": shuffled.random(), **changes})
            outcome = {**OUTCOME, "seconds": shuffled.random(), "exit_status": changes.get("status", 0)}
            (place / "outcome.json").write_text(json.dumps(outcome))
        return out

    def merged(self, sweep, name="out", **changes):
        out = self.write_runs(self.folder / name, sweep, **changes)
        told = sweep_merge.merge(sweep, out)
        with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file)), told, out

    def test_a_row_a_run_and_deformer_in_the_sweeps_order(self):
        rows, told, _ = self.merged(self.sweep)
        self.assertEqual([(row["motion.joint"], row["pbs.iterations"], row["deformer"]) for row in rows],
                         [(joint, count, deformer) for joint in "ab" for count in "312" for deformer in ("lbs", "pbs")])
        self.assertEqual([row["run"] for row in rows[::2]], [run.name for run in self.sweep.runs])
        self.assertEqual((told["runs"], told["exit_statuses"], told["provenance"]["git_revision"]), (6, {"0": 6}, ["abc"]))

    def test_mean_least_and_largest_with_the_states_hash(self):
        rows, _, _ = self.merged(self.sweep)
        pbs = rows[1]  # three iterations: three times 0.1, 0.2, 0.6
        # The numbers and their triples, two sums, the third and 0.9 itself are rounded: six times at most.
        self.assertAlmostEqual(float(pbs["mean_volume_change_pct"]), 0.9, delta=6 * 2**-53 * 0.9)
        self.assertEqual((pbs["least_volume_change_pct"], pbs["largest_volume_change_pct"]), (repr(3 * 0.1), repr(3 * 0.6)))
        self.assertEqual((pbs["frames"], pbs["state_hash"], pbs["mean_bind_rms_m"], pbs["exit_status"]), ("3", "0003", "", "0"))
        self.assertEqual(rows[0]["least_volume_change_pct"], "-0.6")

    def test_numbers_that_are_none_are_left_out(self):
        rows, _, _ = self.merged(self.sweep, volumes=(float("nan"), 0.5, float("inf")))
        self.assertEqual(rows[5]["mean_volume_change_pct"], "1.0")
        rows, _, _ = self.merged(self.sweep, volumes=(float("nan"),))
        self.assertEqual(rows[5]["mean_volume_change_pct"], "")

    def test_breakdowns_are_results(self):
        rows, told, _ = self.merged(self.sweep, status=3)
        columns = ("exit_status", "frames_not_finite", "frames_not_converged", "frames_broken")
        self.assertEqual([[row[column] for column in columns] for row in rows[:2]], [["3", "0", "0", "0"], ["3", "2", "0", "1"]])
        self.assertEqual(told["exit_statuses"], {"3": 6})

    def test_other_order_and_times_make_the_same_bytes(self):
        for rows in ("deformers", "frames"):
            sweep = self.read(SWEEP + f'[output]\nrows = "{rows}"\n')
            _, _, first = self.merged(sweep, "first" + rows, seed=1)
            _, _, second = self.merged(sweep, "second" + rows, seed=2)
            self.assertEqual((first / "sweep.csv").read_bytes(), (second / "sweep.csv").read_bytes())
            self.assertNotEqual((first / "costs.csv").read_bytes(), (second / "costs.csv").read_bytes())  # otherwise nothing was shuffled

    def test_a_row_a_frame(self):
        rows, _, _ = self.merged(self.read(SWEEP + '[output]\nrows = "frames"\n'))
        self.assertEqual(len(rows), 6 * 2 * 3)
        self.assertEqual({"frame": "1", "time_s": "0.01", "volume_change_pct": "0.6000000000000001", "outcome": "finished"},
                         {key: rows[4][key] for key in ("frame", "time_s", "volume_change_pct", "outcome")})
        self.assertNotIn("step_ms", rows[0])

    def test_missing_or_broken_runs_leave_the_table_of_before(self):
        _, _, out = self.merged(self.sweep)
        before = {path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}
        self.assertEqual(set(before), {"sweep.csv", "costs.csv", "sweep.json"})
        place = out / "runs" / self.sweep.runs[3].name
        other = (place / "metrics.csv").read_text().replace("bind_rms_m", "other_m")
        for name, text in (("outcome.json", None), ("run.json", '{"scene"'), ("metrics.csv", ""), ("metrics.csv", other),
                           ("metrics.csv", (place / "metrics.csv").read_text()[:-12])):
            with self.subTest(name, text=text):
                kept = (place / name).read_text()
                (place / name).unlink() if text is None else (place / name).write_text(text)
                with self.assertRaises(sweep_merge.MergeError) as caught:
                    sweep_merge.merge(self.sweep, out)
                self.assertIn(self.sweep.runs[3].name, str(caught.exception))
                self.assertEqual({path.name: path.read_bytes() for path in out.iterdir() if path.is_file()}, before)
                (place / name).write_text(kept)


if __name__ == "__main__":
    unittest.main()
