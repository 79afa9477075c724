"""Sweeps on this machine and on a Slurm cluster of one node, which the test starts and stops. `./check --long` runs it
and sets PBS_LONG=1; with that, a missing program fails the test.

Reference: the other engine. The same sweep writes the same bytes of sweep.csv, also if it was killed and started again
while its jobs were still queued."""
import csv
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

import program
import reliability
import slurm_cluster

SWEEPS = pathlib.Path(program.SOURCE, "experiments/sweeps")
STUDIES = ["momentum", "temporal"]
OWN = pathlib.Path(__file__).with_name("slurm_sweeps")


class Sweeps(program.ProgramTest):
    compared = equal = 0

    @classmethod
    def setUpClass(cls):
        missing = slurm_cluster.missing() + [name for name in ("snakemake",) if not shutil.which(name)]
        if missing:
            raise RuntimeError("not installed: " + ", ".join(missing))
        cls.cluster = slurm_cluster.SlurmCluster()
        cls.cluster.__enter__()
        cls.addClassCleanup(cls.cluster.stop)

    @classmethod
    def tearDownClass(cls):
        reliability.tell("slurm_sweeps", "sweeps on Slurm equal to local ones, byte for byte", Sweeps.equal,
                         Sweeps.compared)

    def command(self, sweep, name, *options, verb="run"):
        what = sweep if verb == "reproduce" else [str(sweep)]
        start = [sys.executable, "-B", str(SWEEPS / "sweep.py"), verb, *what]
        return [*start, "-o", self.path(name), "--pbskin", program.PBSKIN, *options]

    def sweep(self, sweep, name, *options, status=0, verb="run"):
        start = time.monotonic()
        process = subprocess.run(self.command(sweep, name, *options, verb=verb), env=self.cluster.environment,
                                 capture_output=True, text=True, timeout=600)
        print(f"{name}: {time.monotonic() - start:.1f} s", flush=True)
        self.assertEqual(process.returncode, status, process.stderr[-4000:])
        return process

    def assert_same_tables(self, first, second, rows):
        Sweeps.compared += 1
        self.assertEqual(self.read(first, "sweep.csv"), self.read(second, "sweep.csv"))
        self.assertEqual(self.read(first, "sweep.csv").count("\n"), 1 + rows)
        told = [self.json(name, "sweep.json") for name in (first, second)]
        self.assertEqual(told[0]["exit_statuses"], told[1]["exit_statuses"])
        Sweeps.equal += 1

    def jobs_of(self, name):
        return list(pathlib.Path(self.path(name), ".snakemake/slurm_logs").rglob("*.log"))

    def test_a_row_a_frame_in_jobs_of_two_runs(self):
        example = SWEEPS / "examples/limb_bend.toml"
        self.sweep(example, "limb_here", "-j", "2")
        self.sweep(example, "limb_slurm", "--slurm")
        # Shows that Slurm was used.
        self.assertEqual((len(self.jobs_of("limb_here")), len(self.jobs_of("limb_slurm"))), (0, 3))
        self.assert_same_tables("limb_here", "limb_slurm", rows=6 * 3 * 7)

    def test_killed_and_begun_again_while_its_jobs_are_queued(self):
        example = SWEEPS / "examples/human_stiffness.toml"
        self.sweep(example, "human_here", "-j", "2")
        process = subprocess.Popen(self.command(example, "human_slurm", "--slurm"), env=self.cluster.environment,
                                   start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        runs = pathlib.Path(self.path("human_slurm", "runs"))
        try:
            slurm_cluster.wait_for("two runs", lambda: len(list(runs.glob("*/run.json"))) >= 2, 300)
        finally:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        first = {path: path.stat().st_ino for path in runs.glob("*/run.json")}
        self.assertFalse(pathlib.Path(self.path("human_slurm", "sweep.csv")).exists())
        self.assertTrue(self.cluster.told("squeue", "-h").strip())
        self.sweep(example, "human_slurm", "--slurm")
        self.assert_same_tables("human_here", "human_slurm", rows=12 * 2)
        self.assertEqual({path: path.stat().st_ino for path in first}, first)

    def test_studies_of_which_one_measures_time(self):
        here = program.run("reproduce", *STUDIES, "-o", self.path("studies_here"))
        slurm = self.sweep(STUDIES, "studies_slurm", "--slurm", status=here.returncode, verb="reproduce")
        self.assertIn(" claim ", slurm.stdout)
        self.assertEqual(len(self.jobs_of("studies_slurm")), 3)
        self.assertEqual(slurm.stderr.count("slurm_extra=--exclusive"), 1)  # for the run of the study `temporal`
        compared = program.run("compare", self.path("studies_here"), self.path("studies_slurm"))
        self.assertEqual(compared.returncode, 0, compared.stdout)
        self.assertRegex(compared.stdout, r"(?m)^([1-9][\d,]*) of \1 numbers agree, \1 of them in every digit\.$")

    def test_told_to_end_its_jobs_leave_the_queue(self):
        process = subprocess.Popen(self.command(OWN / "long.toml", "ended", "--slurm"), text=True,
                                   env=self.cluster.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        slurm_cluster.wait_for("a job that runs", lambda: self.cluster.told("squeue", "-h", "-t", "R").strip(), 120)
        process.send_signal(signal.SIGINT)
        told = process.communicate(timeout=120)[1]
        self.assertNotEqual(process.returncode, 0, told)
        slurm_cluster.wait_for("an empty queue", lambda: not self.cluster.told("squeue", "-h").strip(), 60)

    def test_bad_input_stops_the_sweep_and_is_in_the_log_of_the_job(self):
        self.sweep(OWN / "bad.toml", "bad", "--slurm", status=1)
        self.assertIn("pbs.k_volume = 1.4", "".join(log.read_text(errors="replace") for log in self.jobs_of("bad")))
        self.assertFalse(pathlib.Path(self.path("bad", "sweep.csv")).exists())

    def test_a_breakdown_is_a_row_of_the_table(self):
        self.sweep(OWN / "breaking.toml", "breaking_here")
        self.sweep(OWN / "breaking.toml", "breaking_slurm", "--slurm")
        self.assert_same_tables("breaking_here", "breaking_slurm", rows=2)
        self.assertEqual(self.json("breaking_slurm", "sweep.json")["exit_statuses"], {"0": 1, "3": 1})


if __name__ == "__main__":
    if not os.environ.get("PBS_LONG"):
        print("skipped: PBS_LONG is not set")
        sys.exit(77)
    unittest.main()
