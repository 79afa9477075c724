"""Reference: the definition, with a substitute for pbskin. A run that ended is never started again; a numerical breakdown is an outcome;
bad input and crashes are not, and their message is kept. The expected sizes are arithmetic."""
import json
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

root = pathlib.Path(__file__).resolve().parents[4]
sys.path[:0] = [str(root / "experiments/sweeps"), str(pathlib.Path(__file__).parent)]

import sweep_file  # noqa: E402
import sweep_runs  # noqa: E402
import sweep_size  # noqa: E402


class SweepRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.program = self.folder / "program"
        self.program.write_text(f"#!/bin/sh\nexec {sys.executable} -B {pathlib.Path(__file__).parent}/synthetic_runs.py \"$@\"\n")
        self.program.chmod(0o755)
        started = mock.patch.dict(os.environ, STARTS=str(self.folder / "starts"))
        started.start()
        self.addCleanup(started.stop)

    def sweep(self, *iterations):
        text = f'schema = 1\nscene = "limb_bend"\n[grid]\npbs.iterations = {list(iterations)}\n[output]\nbatch = {len(iterations)}\n'
        (self.folder / "sweep.toml").write_text(text)
        return sweep_file.read(self.folder / "sweep.toml")

    def finish(self, sweep):
        for name in sweep.batches():
            sweep_runs.finish_batch(sweep, name, self.folder, self.program)
            return json.loads((self.folder / "batches" / f"{name}.json").read_text())

    def starts(self):
        return (self.folder / "starts").read_text().split()

    def test_outcomes_and_what_they_cost(self):
        sweep = self.sweep(1, 101)
        self.assertEqual(list(self.finish(sweep).values()), [0, 3])
        outcome = json.loads((self.folder / "runs" / sweep.runs[0].name / "outcome.json").read_text())
        self.assertEqual(outcome["files"], 4)  # the folder, metrics.csv, run.json, outcome.json
        self.assertGreater(outcome["cpu_seconds"], 0)
        self.assertGreaterEqual(outcome["stored_bytes"], 3 * 4096)

    def test_finished_runs_are_not_started_again(self):
        self.finish(self.sweep(1, 2))
        self.finish(self.sweep(1, 2, 3))
        self.assertEqual(self.starts(), ["1", "2", "3"])

    def test_a_program_that_is_not_there_is_told(self):
        self.program.unlink()
        with self.assertRaises(sweep_runs.RunFailed) as caught:
            self.finish(self.sweep(1))
        self.assertEqual((caught.exception.status, str(caught.exception)), (127, f"{self.program}: No such file or directory"))
        self.assertEqual(len(list((self.folder / "failed").iterdir())), 1)

    def test_of_two_that_do_one_run_the_first_to_end_counts(self):
        sweep = self.sweep(1)
        place = self.folder / "runs" / sweep.runs[0].name
        real_start = sweep_runs.start

        def overtaken(*arguments):
            outcome = real_start(*arguments)
            with mock.patch.object(sweep_runs, "start", real_start):
                self.finish(sweep)
            return outcome

        with mock.patch.object(sweep_runs, "start", overtaken):
            self.assertEqual(list(self.finish(sweep).values()), [0])
        self.assertEqual(self.starts(), ["1", "1"])
        self.assertEqual([path.name for path in place.parent.iterdir()], [place.name])

    def test_a_folder_that_is_no_run_is_told(self):
        sweep = self.sweep(1)
        place = self.folder / "runs" / sweep.runs[0].name
        place.mkdir(parents=True)
        (place / "notes").write_text("")
        with self.assertRaises(sweep_runs.RunFailed) as caught:
            self.finish(sweep)
        self.assertIn("not a finished run", str(caught.exception))

    def test_bad_input_stops_the_job_with_its_message(self):
        sweep = self.sweep(1, 100, 2)
        with self.assertRaises(sweep_runs.RunFailed) as caught:
            self.finish(sweep)
        self.assertEqual((caught.exception.status, str(caught.exception)), (2, "pbskin: --set: pbs.iterations = 100: refused"))
        failed = json.loads((self.folder / "failed" / f"{sweep.runs[1].name}.json").read_text())
        self.assertEqual(failed, {"status": 2, "message": str(caught.exception)})
        self.assertFalse((self.folder / "batches").exists())
        self.assertEqual(self.starts(), ["1", "100"])

    def test_crashes_are_no_outcome_and_are_tried_again(self):
        for _ in range(2):
            with self.assertRaises(sweep_runs.RunFailed) as caught:
                self.finish(self.sweep(1, 102))
            self.assertEqual(caught.exception.status, -9)
        self.assertEqual(self.starts(), ["1", "102", "102"])

    def test_sizes_on_paper(self):
        total = sweep_size.paper([(1.0, 1e6, 5), (3.0, 3e6, 7)], runs=9000, batch=9, cores=10, job_start_s=6.0)
        self.assertEqual((total["jobs"], total["files"], total["storage_gb"]), (1000, 9000 * 6 + 1000, 18.0))
        self.assertAlmostEqual(total["core_hours"], (9000 * 2.0 + 1000 * 6.0) / 3600)
        self.assertAlmostEqual(total["wall_hours"], total["core_hours"] / 10)
        one = sweep_size.paper([(1.0, 1e6, 5)], runs=9, batch=9, cores=10, job_start_s=6.0)
        self.assertAlmostEqual(one["wall_hours"], 15.0 / 3600)  # one job is not divided


if __name__ == "__main__":
    unittest.main()
