"""A killed study resumes where it stopped: runs that ended are kept, the others are done, and the records equal those of an undisturbed
study, including state hashes. Reference: the times of the files, and the records of an undisturbed run."""
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

import limb_alone
import program
import run_records

RUNS = ["limb", "human"]
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def identity(file):
    """Changes if the file is written again."""
    return file.stat().st_mtime_ns, file.stat().st_ino


def alter(file, change):
    record = json.loads(file.read_text())
    change(record)
    file.write_text(json.dumps(record))


class ResumedStudy(program.ProgramTest):
    def setUp(self):
        super().setUp()
        self.whole, self.killed = pathlib.Path(self.path("whole")), pathlib.Path(self.path("killed"))

    def command(self, results, *more, study="momentum"):
        return [program.PBSKIN, "reproduce", study, "-o", str(results), "-j", "1", *more]

    def kill_after_first_run(self, command, study):
        """Kills the study after its first run; returns the record of that run."""
        process = subprocess.Popen(command, **QUIET, start_new_session=True)
        deadline = time.monotonic() + 120
        while not (ended := list(study.glob("*/run.json"))) and time.monotonic() < deadline:
            time.sleep(0.002)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return ended[0]

    def test_killed_and_resumed(self):
        subprocess.run(self.command(self.whole), check=True, **QUIET)
        first = self.kill_after_first_run(self.command(self.killed), self.killed / "momentum")
        ended = identity(first)
        self.assertFalse((self.killed / "claims.json").exists())
        said = subprocess.run(self.command(self.killed, "--resume"), check=True, capture_output=True, text=True).stderr
        self.assertRegex(said, r"runs to do, [1-9]\d* kept")
        self.assertEqual(identity(first), ended)
        for run in RUNS:
            path = pathlib.Path("momentum") / run / "measurements.csv"
            self.assertEqual((self.killed / path).read_text(), (self.whole / path).read_text())
        self.assertEqual((self.killed / "claims.json").read_text(), (self.whole / "claims.json").read_text())

    def test_whole_runs_of_scenes(self):
        by_itself, to_kill = ([*limb_alone.before(), *self.command(results, study="frames")] for results in (self.whole, self.killed))
        subprocess.run(by_itself, check=True, **QUIET)
        first = self.kill_after_first_run(to_kill, self.killed / "frames")
        ended = identity(first)
        subprocess.run([*to_kill, "--resume"], check=True, **QUIET)
        self.assertEqual(identity(first), ended)
        self.assertEqual(run_records.records(self.killed), run_records.records(self.whole))
        self.assertIn("frames/limb_twist/run.json pbs", limb_alone.state_hashes(run_records.records(self.killed)))

    def test_a_run_with_another_setting_is_repeated(self):
        results = self.whole
        subprocess.run(self.command(results, study="audit"), check=True, **QUIET)
        record, resume = results / "audit" / "print" / "run.json", self.command(results, "--resume", study="audit")
        whole = json.loads(record.read_text())
        self.assertEqual(sorted(whole["work"]["settings"]), ["seed", "tets"])
        for setting in whole["work"]["settings"]:
            alter(record, lambda altered: altered["work"]["settings"].update({setting: whole["work"]["settings"][setting] + 1}))
            subprocess.run(resume, check=True, **QUIET)
            self.assertEqual(json.loads(record.read_text())["work"], whole["work"], setting)
        repeated = identity(record)
        subprocess.run(resume, check=True, **QUIET)
        self.assertEqual(identity(record), repeated)

    def verdict(self, results):
        return json.loads((results / "claims.json").read_text())["claims"][0]["verdict"]

    def test_a_part_of_the_runs(self):
        """A verdict needs all runs of its study. Those that are not named are kept if they are finished with the same settings."""
        results = self.whole

        def only(run):
            return subprocess.run(self.command(results, "--only", run), capture_output=True, text=True)

        part = only(RUNS[0])
        self.assertEqual(part.returncode, 1, part.stderr)
        self.assertIn(f"left out by --only: {RUNS[1]}; ", part.stderr)
        self.assertEqual(self.verdict(results), "not_computable")
        record = results / "momentum" / RUNS[0] / "run.json"
        ended = identity(record)
        whole = only(RUNS[1])
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertIn("1 runs to do, 1 kept", whole.stderr)
        self.assertEqual(identity(record), ended)
        self.assertNotEqual(self.verdict(results), "not_computable")
        again = only(RUNS[0])
        self.assertIn("1 runs to do, 1 kept", again.stderr)
        self.assertNotEqual(identity(record), ended)
        alter(record, lambda other: other["work"]["settings"].update(seed="another"))
        self.assertEqual(only(RUNS[1]).returncode, 1)
        self.assertFalse(record.exists())

    def test_a_kept_breakdown_counts(self):
        results = self.whole
        subprocess.run(self.command(results), check=True, **QUIET)
        alter(results / "momentum" / RUNS[0] / "run.json", lambda run: run["outcome"].update(breakdown="vertex 3 is not finite"))
        resumed = subprocess.run(self.command(results, "--resume"), capture_output=True, text=True)
        self.assertEqual(resumed.returncode, 3, resumed.stderr)
        self.assertIn(f"{RUNS[0]}: numerical breakdown: vertex 3 is not finite", resumed.stderr)


if __name__ == "__main__":
    unittest.main()
