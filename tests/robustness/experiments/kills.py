"""A run or study that is killed at any moment, by any signal, once or several times: its files are complete, no process
of the program continues, and --resume keeps the runs that ended, does the others, and ends with the records and the
state hashes of an undisturbed run. Reference: those records and the times of the files; the exit status in
experiments/command_line/README.md; /proc. PBS_KILL_SEED determines the moments."""
import functools
import itertools
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import program
import reliability
import run_records

LONG = bool(os.environ.get("PBS_LONG"))
SEED = int(os.environ.get("PBS_KILL_SEED", "2014"))
STUDIES = ["momentum", "jiggle"] if LONG else ["momentum"]  # limb and human, each of which both studies contain
KILLS = 10 if LONG else 2  # least number of kills, for the studies and for the runs of scenes
SIGNALS = [signal.SIGKILL, signal.SIGINT, signal.SIGTERM]
AIMS = ["parent", "child", "group"]
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def children(of):
    return [process for process, (state, parent, _) in program.statuses().items() if parent == of and state != "Z"]


def send(process, kill, aim, chance):
    """Sends the signal and returns its receiver; a parent without children receives it itself."""
    targets = children(process.pid) if aim == "child" else []
    try:
        if aim == "group":
            os.killpg(process.pid, kill)
            return aim
        if targets:
            os.kill(chance.choice(targets), kill)
            return aim
    except ProcessLookupError:  # the process has just ended
        pass
    process.send_signal(kill)
    return "parent"


def is_pbskin(process):
    try:
        return os.path.samefile(f"/proc/{process.pid}/exe", program.PBSKIN)
    except OSError:  # the process has ended
        return False


LIMB = ["limb_bend_rigid", "limb_twist", *(["limb_bend"] if LONG else [])]


def begin_of_command(studies):
    """Of the study `frames`, only the limb is run, and one run waits for another. The runs of the other studies go side
    by side."""
    if "frames" in studies:
        return [program.PBSKIN, "reproduce", *studies, "-j", "1", *(word for run in LIMB for word in ("--only", run))]
    return [program.PBSKIN, "reproduce", *studies, "-j", "2"]


@functools.cache
def undisturbed(*studies):
    """The folder of the finished studies, and the seconds that they took."""
    temporary = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(temporary.cleanup)
    start = time.monotonic()
    subprocess.run([*begin_of_command(studies), "-o", temporary.name], check=True, **QUIET)
    return pathlib.Path(temporary.name), time.monotonic() - start


class Kills(program.ProgramTest):
    kills = survived = hashes = 0

    @classmethod
    def tearDownClass(cls):
        reliability.tell("kills", "kills survived: whole files, no process left, the same records and state hashes "
                                  "after --resume",
                         cls.survived, cls.kills, note=f"seed {SEED}, {cls.hashes:,} state hashes compared")

    def setUp(self):
        super().setUp()
        self.chance = random.Random(SEED)
        self.ways = list(itertools.product(SIGNALS, AIMS))
        self.chance.shuffle(self.ways)

    def command(self, folder):
        return [*begin_of_command(self.studies), "-o", str(folder), "--resume"]

    def begin(self, folder):
        """The process, once it executes pbskin."""
        process = subprocess.Popen(self.command(folder), start_new_session=True, **QUIET)
        while process.poll() is None and not is_pbskin(process):
            time.sleep(0.001)
        return process

    def expect_nothing_goes_on(self, session):
        deadline = time.monotonic() + 1  # shorter than a run
        while left := [pid for pid, (state, _, its_session) in program.statuses().items() if its_session == session
                       and state != "Z"]:
            if time.monotonic() > deadline:
                break
            time.sleep(0.01)
        self.assertEqual(left, [], "processes that go on")

    def expect_whole(self, folder, temporaries_allowed):
        for path in run_records.files(folder):
            if run_records.is_temporary(path):
                self.assertTrue(temporaries_allowed, path)
            else:
                self.assertIsNone(run_records.what_is_torn(path))

    def expect_status(self, status, kill, aim, folder):
        if aim == "child":  # the run is lost, and a verdict with it
            self.assertEqual(status, 1)
        elif kill == signal.SIGKILL:
            self.assertEqual(status, -kill)
        elif not list(folder.glob("*/plan.json")):  # the program may not have handled signals yet
            self.assertIn(status, (-kill, 130))
        else:
            self.assertEqual(status, 130)

    def kill_once(self, folder, seconds):
        """Whether the signal interrupted work; a resumed run keeps what the last one finished."""
        (kill, aim), moment = self.ways[0], self.chance.uniform(0.02, seconds)
        process = self.begin(folder)
        try:
            process.wait(moment)
        except subprocess.TimeoutExpired:
            self.ways.append(self.ways.pop(0))
            hit = send(process, kill, aim, self.chance)
            status = process.wait(60)
            if status == 0:  # it had finished before the signal, or the child that received it had
                self.assertEqual(run_records.records(folder), self.undisturbed)
                return False
            with self.subTest(kill=kill.name, hit=hit, moment_s=round(moment, 3), seed=SEED):
                self.expect_status(status, kill, hit, folder)
                self.expect_nothing_goes_on(process.pid)
                self.expect_whole(folder, temporaries_allowed=kill == signal.SIGKILL)
                type(self).survived += 1
            return True
        return False

    def kill_and_resume(self, *studies):
        """State hashes of the undisturbed run, after a check that those of every other run are equal."""
        self.studies = studies
        whole, seconds = undisturbed(*studies)
        self.undisturbed = run_records.records(whole)
        self.assertGreater(len(self.undisturbed), 5)
        folder, kills = pathlib.Path(self.path("killed")), 0
        while kills < KILLS:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            kills += sum(self.kill_once(folder, seconds) for _ in range(self.chance.choice([1, 2, 3])))
            subprocess.run(self.command(folder), check=True, **QUIET)
            resumed = run_records.records(folder)
            self.assertEqual(resumed, self.undisturbed)
            type(self).hashes += len(run_records.state_hashes(resumed))
        type(self).kills += kills
        return run_records.state_hashes(self.undisturbed)

    def test_studies_of_the_limb_and_the_human(self):
        self.kill_and_resume(*STUDIES)

    def test_whole_runs_of_scenes(self):
        hashes = self.kill_and_resume("frames")
        self.assertIn("frames/limb_twist/run.json pbs", hashes)


RUNS = ["limb", "human"]


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

    def command(self, results, *more):
        return [program.PBSKIN, "reproduce", "momentum", "-o", str(results), "-j", "1", *more]

    def test_killed_and_resumed(self):
        whole, _ = undisturbed("momentum")
        process = subprocess.Popen(self.command(self.killed), **QUIET, start_new_session=True)
        deadline = time.monotonic() + 120
        while not (ended := list(self.killed.glob("momentum/*/run.json"))) and time.monotonic() < deadline:
            time.sleep(0.002)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        first, before = ended[0], identity(ended[0])
        self.assertFalse((self.killed / "claims.json").exists())
        said = subprocess.run(self.command(self.killed, "--resume"), check=True, capture_output=True, text=True).stderr
        self.assertRegex(said, r"runs to do, [1-9]\d* kept")
        self.assertEqual(identity(first), before)
        for run in RUNS:
            path = pathlib.Path("momentum") / run / "measurements.csv"
            self.assertEqual((self.killed / path).read_text(), (whole / path).read_text())
        self.assertEqual((self.killed / "claims.json").read_text(), (whole / "claims.json").read_text())

    def test_a_part_of_the_runs(self):
        """A verdict needs all runs of its study. Those that are not named are kept if they are finished with the same
        settings."""
        results = self.whole

        def only(run):
            return subprocess.run(self.command(results, "--only", run), capture_output=True, text=True)

        part = only(RUNS[0])
        self.assertEqual(part.returncode, 1, part.stderr)
        self.assertIn(f"excluded by --only: {RUNS[1]}; ", part.stderr)
        self.assertIn(f"C07 cannot be computed here: no record of {RUNS[1]}\n", part.stdout)
        record = results / "momentum" / RUNS[0] / "run.json"
        ended = identity(record)
        whole = only(RUNS[1])
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertIn("1 runs to do, 1 kept", whole.stderr)
        self.assertEqual(identity(record), ended)
        self.assertNotIn("cannot be computed", whole.stdout)
        again = only(RUNS[0])
        self.assertIn("1 runs to do, 1 kept", again.stderr)
        self.assertNotEqual(identity(record), ended)
        alter(record, lambda other: other["work"]["settings"].update(seed="another"))
        self.assertEqual(only(RUNS[1]).returncode, 1)
        self.assertFalse(record.exists())

    @unittest.skipUnless(shutil.which("snakemake"), "snakemake is not installed")
    def test_by_a_workflow(self):
        """It ends as `reproduce` does, with the same records. A run that fails is named, and it alone is made again."""
        whole, _ = undisturbed("momentum")
        self.script("failing",
                    f'case "$*" in *"--only human"*) exit 2;; esac\nexec {program.PBSKIN} "$@"\n')
        results = self.killed.relative_to(self.folder)

        def workflow(pbskin):
            sweep = pathlib.Path(program.SOURCE, "experiments/sweeps/sweep.py")
            return subprocess.run([sys.executable, "-B", sweep, "reproduce", "momentum", "-o", results, "-j", "2",
                                   "--pbskin", pbskin], cwd=self.folder, capture_output=True, text=True)

        failed = workflow("./failing")
        self.assertEqual(failed.returncode, 1, failed.stderr)
        self.assertIn("momentum/human/run.json", failed.stderr)
        self.assertFalse((self.killed / "claims.json").exists())
        first = self.killed / "momentum" / "limb" / "run.json"
        before = identity(first)
        ended = workflow(program.PBSKIN)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertIn(f"next: pbskin report {results}\n", ended.stdout)
        self.assertEqual(identity(first), before)
        made = run_records.records(self.killed)
        self.assertEqual({name: made.get(name) for name in run_records.records(whole)}, run_records.records(whole))

    def test_a_kept_breakdown_counts(self):
        results = self.whole
        shutil.copytree(undisturbed("momentum")[0], results)
        alter(results / "momentum" / RUNS[0] / "run.json",
              lambda run: run["outcome"].update(breakdown="vertex 3 is not finite"))
        resumed = subprocess.run(self.command(results, "--resume"), capture_output=True, text=True)
        self.assertEqual(resumed.returncode, 3, resumed.stderr)
        self.assertIn(f"{RUNS[0]}: numerical breakdown: vertex 3 is not finite", resumed.stderr)


if __name__ == "__main__":
    unittest.main()
