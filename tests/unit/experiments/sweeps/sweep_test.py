"""Reference: the definition. A sweep expands to every combination once; invalid ones are refused with file, line,
field, value and rule. The tables of runs with known metrics do not depend on their order, times or machine. With
snakemake, finished runs are never started again."""
import contextlib
import csv
import fcntl
import io
import itertools
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

root = pathlib.Path(__file__).resolve().parents[4]
sys.path[:0] = [str(root / "experiments/sweeps"), str(pathlib.Path(__file__).parent)]

import merge  # noqa: E402
import sweep as sweeps  # noqa: E402
import synthetic_runs  # noqa: E402

GOOD = pathlib.Path(__file__).with_name("good.toml").read_text()
REFUSED = tomllib.loads(pathlib.Path(__file__).with_name("refused.toml").read_text())["rows"]


class SweepTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.file = self.folder / "sweep.toml"

    def read(self, text):
        self.file.write_text(text, encoding="utf-8")
        return sweeps.read(self.file)


class SweepFile(SweepTest):
    def test_every_combination_once_the_last_key_fastest(self):
        plan = self.read(GOOD)
        self.assertEqual([tuple(keys.values()) for keys in plan.runs.values()],
                         list(itertools.product(["0.1", "0.2"], ["1", "2", "3"])))
        self.assertEqual(plan.arguments(list(plan.runs)[4])[6::2],
                         ["motion.frames=3", 'deformers.use=["lbs", "pbs"]', "pbs.k_stretch=0.2", "pbs.iterations=2"])

    def test_listed_runs_each_over_the_grid(self):
        plan = self.read(GOOD + "[[run]]\nmotion.joint = 'a'\n[[run]]\nmotion.joint = 'b'\n")
        self.assertEqual([keys["motion.joint"] for keys in plan.runs.values()], ['"a"'] * 6 + ['"b"'] * 6)

    def test_names_are_of_what_runs_not_of_the_file(self):
        names = set(self.read(GOOD).runs)
        longer = "# a note\n" + GOOD.replace("0.2]", "0.2, 0.3]").replace("[grid]", "[output]\nbatch = 2\n[grid]")
        self.assertLess(names, set(self.read(longer).runs))
        for change in (("frames = 3", "frames = 4"), ("limb_bend", "limb_twist")):
            self.assertFalse(names & set(self.read(GOOD.replace(*change)).runs))

    def test_files_that_scene_and_keys_name_with_what_is_read_along(self):
        files = {"own.toml": '[character]\nmesh = "arm.node"\n', "arm.node": "1", "arm.ele": "1", "w.csv": "1",
                 "other.csv": "1"}
        for name, text in files.items():
            (self.folder / name).write_text(text)
        plan = self.read(GOOD.replace("limb_bend", "own.toml").replace("motion.frames = 3",
                                                                       'skinning.weights = "w.csv"'))
        self.assertEqual([pathlib.Path(file).name for file in plan.files], ["arm.ele", "arm.node", "own.toml", "w.csv"])
        self.assertEqual(plan.scene, str((self.folder / "own.toml").resolve()))
        absolute = GOOD.replace("motion.frames = 3", f'skinning.weights = "{self.folder / "w.csv"}"')
        self.assertEqual(self.read(absolute).files, [str(self.folder / "w.csv")])

    def test_bad_sweeps_are_refused_where_they_are_bad(self):
        for name, old, new, line, told in REFUSED:
            with self.subTest(name):
                self.assertIn(old, GOOD)
                with self.assertRaises(sweeps.SweepError) as caught:
                    self.read(GOOD.replace(old, new, 1))
                self.assertTrue(str(caught.exception).startswith(f"{self.file}:{line}: " if line else f"{self.file}: "),
                                caught.exception)
                self.assertIn(told, str(caught.exception))

    def test_unreadable_files_are_refused(self):
        self.file.write_bytes(b"schema = 1\n\xff\xfe")
        for file, told in ((self.file, "utf-8"), (self.folder / "absent.toml", "No such file"),
                           (self.folder, "directory")):
            with self.subTest(told), self.assertRaisesRegex(sweeps.SweepError, told):
                sweeps.read(file)

    def test_examples_are_sweeps(self):
        for example in sorted((root / "experiments/sweeps/examples").glob("*.toml")):
            self.assertGreater(len(sweeps.read(example).runs), 1, example.name)


class Tables(SweepTest):
    text = 'schema = 1\nscene = "limb_bend"\n[grid]\nmotion.joint = ["a", "b"]\npbs.iterations = [3, 1, 2]\n'

    def merged(self, name="out", seed=1, more="", **changes):
        plan, out, shuffled = self.read(self.text + more), self.folder / name, random.Random(seed)
        for run in shuffled.sample(list(plan.runs), len(plan.runs)):
            synthetic_runs.write(out / "runs" / run, int(plan.runs[run]["pbs.iterations"]),
                                 **{"step_ms": shuffled.random(), **changes})
        merge.write(plan, out)
        with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file)), json.loads((out / "sweep.json").read_text()), out

    def test_a_row_a_run_and_deformer_in_the_sweeps_order(self):
        rows, told, _ = self.merged()
        self.assertEqual([(row["motion.joint"], row["pbs.iterations"], row["deformer"]) for row in rows],
                         [(joint, count, deformer) for joint in "ab" for count in "312" for deformer in ("lbs", "pbs")])
        self.assertEqual((told["runs"], told["exit_statuses"], told["provenance"]["git_revision"]),
                         (6, {"0": 6}, ["abc"]))

    def test_mean_least_and_largest_with_the_states_hash(self):
        rows, _, _ = self.merged()
        pbs = rows[1]  # three iterations: three times 0.1, 0.2, 0.6
        # The numbers and their triples, two sums, the third and 0.9 itself are rounded: six times at most.
        self.assertAlmostEqual(float(pbs["mean_volume_change_pct"]), 0.9, delta=6 * 2**-53 * 0.9)
        self.assertEqual((pbs["least_volume_change_pct"], pbs["largest_volume_change_pct"]),
                         (repr(3 * 0.1), repr(3 * 0.6)))
        self.assertEqual((pbs["frames"], pbs["state_hash"], pbs["mean_bind_rms_m"], pbs["exit_status"]),
                         ("3", "0003", "", "0"))

    def test_numbers_that_are_none_are_left_out(self):
        for volumes, mean in (((float("nan"), 0.5, float("inf")), "1.0"), ((float("nan"),), "")):
            self.assertEqual(self.merged(volumes=volumes)[0][5]["mean_volume_change_pct"], mean)

    def test_breakdowns_are_results(self):
        rows, told, _ = self.merged(status=3)
        columns = ("exit_status", "frames_not_finite", "frames_not_converged", "frames_broken")
        self.assertEqual([[row[column] for column in columns] for row in rows[:2]],
                         [["3", "0", "0", "0"], ["3", "2", "0", "1"]])
        self.assertEqual(told["exit_statuses"], {"3": 6})

    def test_rows_of_another_variant_do_not_count_and_several_revisions_are_named(self):
        plan, out = self.read(self.text), self.folder / "out"
        for number, run in enumerate(plan.runs):
            synthetic_runs.write(out / "runs" / run, 1)
            record = out / "runs" / run / "run.json"
            record.write_text(record.read_text().replace('"abc"', f'"abc{number % 2}"'))
            with open(out / "runs" / run / "metrics.csv", "a", encoding="utf-8") as file:
                file.write("s,pbs,jiggle,ordered,f32,1,1,0,0,99,,1,finished\n")
        with contextlib.redirect_stderr(io.StringIO()) as errors:
            merge.write(plan, out)
        with open(out / "sweep.csv", newline="", encoding="utf-8") as file:
            self.assertEqual(list(csv.DictReader(file))[1]["largest_volume_change_pct"], "0.6")
        self.assertIn("the runs are of several revisions", errors.getvalue())

    def test_other_order_and_times_make_the_same_bytes(self):
        for rows in ("deformers", "frames"):
            first, second = (self.merged(f"{rows}{seed}", seed, f'[output]\nrows = "{rows}"\n')[2] for seed in (1, 2))
            self.assertEqual((first / "sweep.csv").read_bytes(), (second / "sweep.csv").read_bytes())
            # Equal costs would mean that nothing was shuffled.
            self.assertNotEqual((first / "costs.csv").read_bytes(), (second / "costs.csv").read_bytes())

    def test_a_row_a_frame(self):
        rows, _, _ = self.merged(more='[output]\nrows = "frames"\n')
        self.assertEqual(len(rows), 6 * 2 * 3)
        self.assertLessEqual({"frame": "1", "time_s": "0.01", "volume_change_pct": "0.6000000000000001",
                              "outcome": "finished"}.items(),
                             rows[4].items())


@unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
class Runs(SweepTest):
    def sweep(self, iterations, status=0):
        """The iterations of the runs that were started, and the messages."""
        self.file.write_text(f'schema = 1\nscene = "limb_bend"\n[grid]\npbs.iterations = {iterations}\n')
        starts = self.folder / "starts"
        starts.unlink(missing_ok=True)
        program = self.folder / "pbskin"
        program.write_text(f"#!/bin/sh\nexec {sys.executable} -B {synthetic_runs.__file__} \"$@\"\n")
        program.chmod(0o755)
        process = subprocess.run([sys.executable, "-B", sweeps.__file__, "run", self.file, "-o", self.folder / "out",
                                  "--pbskin", program],
                                 env=os.environ | {"STARTS": str(starts)}, capture_output=True, text=True, timeout=100)
        self.assertEqual(process.returncode, status, process.stderr)
        return sorted(map(int, starts.read_text().split())) if starts.exists() else [], process.stderr

    def test_finished_runs_are_not_started_again(self):
        self.assertEqual(self.sweep([1, 101])[0], [1, 101])  # a breakdown is a result
        self.assertEqual(self.sweep([1, 101])[0], [])
        self.assertEqual(self.sweep([1, 101, 2])[0], [2])
        shutil.rmtree(next((self.folder / "out" / "runs").iterdir()))
        self.assertEqual(len(self.sweep([1, 101, 2])[0]), 1)
        with open(self.folder / "out" / "sweep.csv", newline="", encoding="utf-8") as file:
            self.assertEqual([row["exit_status"] for row in csv.DictReader(file) if row["deformer"] == "pbs"],
                             ["0", "3", "0"])

    def test_bad_input_stops_the_sweep_with_its_message(self):
        self.assertIn("pbs.iterations = 100: refused", self.sweep([100, 1], status=1)[1])
        self.assertFalse((self.folder / "out" / "sweep.csv").exists())

    def test_two_sweeps_in_one_folder_are_refused(self):
        (self.folder / "out").mkdir()
        with open(self.folder / "out" / ".lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.assertIn("another sweep runs there", self.sweep([1], status=2)[1])


if __name__ == "__main__":
    unittest.main()
