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


class ResumedStudy(program.ProgramTest):
    def command(self, results, *more, study="momentum"):
        return [program.PBSKIN, "reproduce", study, "-o", str(results), "-j", "1", *more]

    def kill_after_first_run(self, command, study):
        """Kills the study after its first run; returns the record of that run."""
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        deadline = time.monotonic() + 120
        while not (ended := list(study.glob("*/run.json"))) and time.monotonic() < deadline:
            time.sleep(0.002)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return ended[0]

    def test_killed_and_resumed(self):
        whole, killed = pathlib.Path(self.path("whole")), pathlib.Path(self.path("killed"))
        subprocess.run(self.command(whole), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        first = self.kill_after_first_run(self.command(killed), killed / "momentum")
        ended = first.stat()
        self.assertFalse((killed / "claims.json").exists())
        said = subprocess.run(self.command(killed, "--resume"), check=True, capture_output=True, text=True).stderr
        self.assertRegex(said, r"runs to do, [1-9]\d* kept")
        self.assertEqual((first.stat().st_mtime_ns, first.stat().st_ino), (ended.st_mtime_ns, ended.st_ino))
        for run in RUNS:
            path = pathlib.Path("momentum") / run / "measurements.csv"
            self.assertEqual((killed / path).read_text(), (whole / path).read_text())
        self.assertEqual((killed / "claims.json").read_text(), (whole / "claims.json").read_text())

    def test_whole_runs_of_scenes(self):
        whole, killed = pathlib.Path(self.path("whole")), pathlib.Path(self.path("killed"))
        by_itself, to_kill = ([*limb_alone.before(), *self.command(results, study="frames")] for results in (whole, killed))
        subprocess.run(by_itself, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        first = self.kill_after_first_run(to_kill, killed / "frames")
        ended = first.stat()
        subprocess.run([*to_kill, "--resume"], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual((first.stat().st_mtime_ns, first.stat().st_ino), (ended.st_mtime_ns, ended.st_ino))
        self.assertEqual(run_records.records(killed), run_records.records(whole))
        self.assertIn("frames/limb_twist/run.json pbs", limb_alone.state_hashes(run_records.records(killed)))

    def test_a_run_with_another_setting_is_repeated(self):
        results = pathlib.Path(self.path("whole"))
        subprocess.run(self.command(results, study="audit"), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        record, resume = results / "audit" / "print" / "run.json", self.command(results, "--resume", study="audit")
        whole = json.loads(record.read_text())
        self.assertEqual(sorted(whole["work"]["settings"]), ["seed", "tets"])
        for setting in whole["work"]["settings"]:
            altered = json.loads(json.dumps(whole))
            altered["work"]["settings"][setting] += 1
            record.write_text(json.dumps(altered))
            subprocess.run(resume, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.assertEqual(json.loads(record.read_text())["work"], whole["work"], setting)
        repeated = record.stat()
        subprocess.run(resume, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual((record.stat().st_mtime_ns, record.stat().st_ino), (repeated.st_mtime_ns, repeated.st_ino))

    def verdict(self, results):
        return json.loads((results / "claims.json").read_text())["claims"][0]["verdict"]

    def test_a_part_of_the_runs(self):
        """A verdict needs all runs of its study. Those that are not named are kept if they are finished with the same settings."""
        results = pathlib.Path(self.path("part"))

        def only(run):
            return subprocess.run(self.command(results, "--only", run), capture_output=True, text=True)

        part = only(RUNS[0])
        self.assertEqual(part.returncode, 1, part.stderr)
        self.assertIn(f"left out by --only: {RUNS[1]}; ", part.stderr)
        self.assertEqual(self.verdict(results), "not_computable")
        record = results / "momentum" / RUNS[0] / "run.json"
        ended = record.stat()
        whole = only(RUNS[1])
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertIn("1 runs to do, 1 kept", whole.stderr)
        self.assertEqual((record.stat().st_mtime_ns, record.stat().st_ino), (ended.st_mtime_ns, ended.st_ino))
        self.assertNotEqual(self.verdict(results), "not_computable")
        again = only(RUNS[0])
        self.assertIn("1 runs to do, 1 kept", again.stderr)
        self.assertNotEqual((record.stat().st_mtime_ns, record.stat().st_ino), (ended.st_mtime_ns, ended.st_ino))
        other = json.loads(record.read_text())
        other["work"]["settings"]["seed"] = "another"
        record.write_text(json.dumps(other))
        self.assertEqual(only(RUNS[1]).returncode, 1)
        self.assertFalse(record.exists())

    def test_a_kept_breakdown_counts(self):
        results = pathlib.Path(self.path("whole"))
        subprocess.run(self.command(results), check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        record = results / "momentum" / RUNS[0] / "run.json"
        run = json.loads(record.read_text())
        run["outcome"]["breakdown"] = "vertex 3 is not finite"
        record.write_text(json.dumps(run))
        resumed = subprocess.run(self.command(results, "--resume"), capture_output=True, text=True)
        self.assertEqual(resumed.returncode, 3, resumed.stderr)
        self.assertIn(f"{RUNS[0]}: numerical breakdown: vertex 3 is not finite", resumed.stderr)


if __name__ == "__main__":
    unittest.main()
