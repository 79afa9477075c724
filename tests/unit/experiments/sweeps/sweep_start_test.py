"""Reference: the definition, with a substitute for pbskin, and with snakemake itself where it is installed. Removed results are made again.
A sweep that is told to end ends with all that it started, and can continue later. Wrong usage is refused before anything starts."""
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

root = pathlib.Path(__file__).resolve().parents[4]
here = pathlib.Path(__file__).parent
sys.path[:0] = [str(root / "experiments/sweeps"), str(here)]

import pbskin_program  # noqa: E402
import sweep_file  # noqa: E402
import sweep_start  # noqa: E402
import synthetic_runs  # noqa: E402

SLOW = 103  # iterations of a run that takes a minute
needs_snakemake = unittest.skipUnless(shutil.which("snakemake"), "snakemake is not there")


class Program(unittest.TestCase):
    def made(self, path):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n")
        path.chmod(0o755)
        return path

    def test_of_the_checkout_the_installation_or_the_path(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, {"PATH": f"{folder}/path"}):
            tree, prefix = pathlib.Path(folder, "tree"), pathlib.Path(folder, "prefix")
            of_tree, of_prefix = tree / "build/release/bin/pbskin", prefix / "bin/pbskin"
            scripts = {of_tree: tree / "experiments/sweeps", of_prefix: prefix / "share/pbskin/sweeps"}
            for place, here in scripts.items():
                self.assertEqual(pbskin_program.found(here), place)  # the message states what is missing
            on_path = self.made(pathlib.Path(folder, "path/pbskin"))
            for place, here in scripts.items():
                self.assertEqual(pbskin_program.found(here), on_path)
                self.made(place)
                self.assertEqual(pbskin_program.found(here), place)


class SweepStart(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"
        self.program = self.folder / "program"
        self.program.write_text(f"#!/bin/sh\nexec {sys.executable} -B {here}/synthetic_runs.py \"$@\"\n")
        self.program.chmod(0o755)

    def sweep(self, *iterations):
        (self.folder / "sweep.toml").write_text(f'schema = 1\nscene = "limb_bend"\n[grid]\npbs.iterations = {list(iterations)}\n')
        return sweep_file.read(self.folder / "sweep.toml")

    def start(self, *options, out=None):
        command = [sys.executable, "-B", root / "experiments/sweeps/sweep.py", "run", self.folder / "sweep.toml", "-o", out or self.out,
                   "--pbskin", self.program, *options]
        environment = {**os.environ, "STARTS": str(self.folder / "starts"), "XDG_CACHE_HOME": str(self.folder)}
        return subprocess.Popen([str(word) for word in command], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def run_sweep(self, *options, status=0, out=None):
        process = self.start(*options, out=out)
        _, told = process.communicate(timeout=60)
        self.assertEqual(process.returncode, status, told)
        return told

    def starts(self):
        return sorted((self.folder / "starts").read_text().split())

    def finished(self, sweep):
        """The state that a sweep leaves, without snakemake."""
        for run in sweep.runs:
            synthetic_runs.write(self.out / "runs" / run.name, 1)
            (self.out / "runs" / run.name / "outcome.json").write_text("{}")
        for name, runs in sweep.batches().items():
            (self.out / "batches").mkdir(exist_ok=True)
            (self.out / "batches" / f"{name}.json").write_text(json.dumps({run.name: 0 for run in runs}))
        (self.out / "sweep.json").write_text("{}")

    def test_marks_of_lost_runs_are_forgotten(self):
        sweep = self.sweep(1, 2)
        self.finished(sweep)
        sweep_start.forget_lost_runs(self.out)
        self.assertEqual((len(list(self.out.glob("batches/*.json"))), (self.out / "sweep.json").exists()), (2, True))
        shutil.rmtree(self.out / "runs" / sweep.runs[0].name)
        sweep_start.forget_lost_runs(self.out)
        self.assertEqual([path.stem for path in self.out.glob("batches/*.json")], [sweep.runs[1].name])
        self.assertFalse((self.out / "sweep.json").exists())

    def test_runs_of_another_revision_are_told(self):
        sweep = self.sweep(1, 2)
        self.finished(sweep)
        self.assertEqual(sweep_start.runs_of_other_revisions(sweep, self.out, self.program), [])
        record = self.out / "runs" / sweep.runs[1].name / "run.json"
        for change in ({"git_revision": "0123456789abcdef"}, {"git_dirty": True}):
            told = json.loads(record.read_text())
            record.write_text(json.dumps({**told, "provenance": {**told["provenance"], **change}}))
            self.assertEqual(sweep_start.runs_of_other_revisions(sweep, self.out, self.program), [sweep.runs[1].name], change)
            record.write_text(json.dumps(told))

    def test_a_program_that_states_no_revision_is_no_other_revision(self):
        sweep = self.sweep(1)
        self.finished(sweep)
        for output in ("", "pbskin 0.1.0 (git def)", "[]", "{}"):
            program = self.folder / "silent"
            program.write_text(f"#!/bin/sh\necho '{output}'\n")
            program.chmod(0o755)
            self.assertEqual(sweep_start.runs_of_other_revisions(sweep, self.out, program), [], output)

    def test_bad_usage_is_refused(self):
        self.sweep(1)
        (self.folder / "file").write_text("")
        for words, out, rule in ((["-j", "0"], None, "--jobs = 0: expected at least 1"),
                                 ([], self.folder / "file", "expected a folder to write to"),
                                 (["--pbskin", self.folder / "absent"], None, "no such program")):
            with self.subTest(rule):
                options = sweep_start_options(words, out or self.out, self.program)
                with self.assertRaises(sweep_start.StartError) as caught, unittest.mock.patch("shutil.which", return_value="snakemake"):
                    sweep_start.ready(options)
                    sweep_start.locked(options.output)
                self.assertIn(rule, str(caught.exception))
        self.assertIn("sweep: --jobs = 0", self.run_sweep("-j", "0", status=2))

    def test_two_in_one_folder_are_refused(self):
        held = sweep_start.locked(self.out)
        with self.assertRaises(sweep_start.StartError):
            sweep_start.locked(self.out)
        os.close(held)
        os.close(sweep_start.locked(self.out))

    @needs_snakemake
    def test_what_was_removed_is_made_again(self):
        sweep = self.sweep(1, 2)
        self.run_sweep()
        table = (self.out / "sweep.csv").read_bytes()
        shutil.rmtree(self.out / "runs" / sweep.runs[0].name)
        (self.out / "sweep.csv").unlink()
        self.run_sweep()
        self.assertEqual(self.starts(), ["1", "1", "2"])
        self.assertEqual((self.out / "sweep.csv").read_bytes(), table)
        (self.out / "sweep.csv").unlink()
        self.run_sweep()
        self.assertEqual((self.out / "sweep.csv").read_bytes(), table)
        self.assertEqual(self.starts(), ["1", "1", "2"])

    @needs_snakemake
    def test_told_to_end_it_leaves_nothing_running(self):
        sweep = self.sweep(1, SLOW)
        for number in (signal.SIGTERM, signal.SIGINT):
            with self.subTest(number.name):
                process = self.start()
                slow = self.folder / "slow"
                wait_for(slow.exists)
                running = int(slow.read_text())
                process.send_signal(number)
                _, told = process.communicate(timeout=30)
                self.assertEqual(process.returncode, sweep_start.INTERRUPTED, told)
                self.assertEqual(told.splitlines()[-1], "sweep: interrupted; what is finished is kept, and the same command goes on")
                self.assertNotIn("Traceback", told)
                self.assertFalse(pathlib.Path("/proc", str(running)).exists())
                with open(self.out / ".lock", encoding="utf-8") as lock:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                self.assertEqual([path.name for path in (self.out / "runs").iterdir()], [sweep.runs[0].name])
                slow.unlink()
        self.assertEqual(self.starts(), ["1", str(SLOW), str(SLOW)])


def sweep_start_options(words, output, program):
    """The options of `sweep.py run`."""
    import sweep
    return sweep.arguments(["run", "sweep.toml", "-o", str(output), "--pbskin", str(program), *map(str, words)])[0]


def wait_for(condition, seconds=30):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError
        time.sleep(0.05)


if __name__ == "__main__":
    unittest.main()
