"""A run that is killed at any moment, by any signal, once or several times: its files are complete, no process of the program continues,
and --resume ends with the records and the state hashes of an undisturbed run. Reference: those records; the exit status in
experiments/command_line/README.md; /proc. PBS_KILL_SEED determines the moments."""
import itertools
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time
import unittest

import limb_alone
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


def statuses():
    """Process -> (state, parent, session) of all processes."""
    found = {}
    for entry in os.listdir("/proc"):
        try:
            fields = pathlib.Path("/proc", entry, "stat").read_text().rsplit(")", 1)[1].split() if entry.isdigit() else None
        except OSError:  # the process has ended meanwhile
            continue
        if fields:
            found[int(entry)] = (fields[0], int(fields[1]), int(fields[3]))
    return found


def of_session(session):
    return [process for process, (state, _, its_session) in statuses().items() if its_session == session and state != "Z"]


def children(of):
    return [process for process, (state, parent, _) in statuses().items() if parent == of and state != "Z"]


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


class Kills(program.ProgramTest):
    kills = survived = hashes = 0

    @classmethod
    def tearDownClass(cls):
        reliability.tell("kills", "kills survived: whole files, no process left, the same records and state hashes after --resume",
                         cls.survived, cls.kills, note=f"seed {SEED}, {cls.hashes:,} state hashes compared")

    def setUp(self):
        super().setUp()
        self.chance = random.Random(SEED)
        self.ways = list(itertools.product(SIGNALS, AIMS))
        self.chance.shuffle(self.ways)

    def command(self, folder, *more):
        return [*self.before, program.PBSKIN, "reproduce", *self.studies, "-o", str(folder), "-j", "2", *more]

    def begin(self, folder):
        """The process, once it executes pbskin."""
        process = subprocess.Popen(self.command(folder, "--resume"), start_new_session=True, **QUIET)
        while process.poll() is None and not is_pbskin(process):
            time.sleep(0.001)
        return process

    def expect_nothing_goes_on(self, session):
        deadline = time.monotonic() + 1  # shorter than a run
        while (left := of_session(session)) and time.monotonic() < deadline:
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
        elif kill == signal.SIGKILL or not list(folder.glob("*/plan.json")):  # without a plan, the program did not handle signals yet
            self.assertEqual(status, -kill)
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

    def kill_and_resume(self, studies, before=()):
        """State hashes of the undisturbed run, after a check that those of every other run are equal."""
        self.studies, self.before = studies, before
        whole = pathlib.Path(self.path("whole"))
        start = time.monotonic()
        subprocess.run(self.command(whole), check=True, **QUIET)
        seconds = time.monotonic() - start
        self.undisturbed = run_records.records(whole)
        self.assertGreater(len(self.undisturbed), 5)
        folder, kills = pathlib.Path(self.path("killed")), 0
        while kills < KILLS:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            kills += sum(self.kill_once(folder, seconds) for _ in range(self.chance.choice([1, 2, 3])))
            subprocess.run(self.command(folder, "--resume"), check=True, **QUIET)
            resumed = run_records.records(folder)
            self.assertEqual(resumed, self.undisturbed)
            type(self).hashes += len(limb_alone.state_hashes(resumed))
        type(self).kills += kills
        return limb_alone.state_hashes(self.undisturbed)

    def test_studies_of_the_limb_and_the_human(self):
        self.kill_and_resume(STUDIES)

    def test_whole_runs_of_scenes(self):
        hashes = self.kill_and_resume(["frames"], limb_alone.before())
        self.assertIn("frames/limb_twist/run.json pbs", hashes)


class KilledReport(program.ProgramTest):
    def test_the_page_is_whole_or_not_there(self):
        results, chance = pathlib.Path(self.path("results")), random.Random(SEED)
        self.succeeds("reproduce", "momentum", "-o", results)
        start = time.monotonic()
        self.succeeds("report", results)
        seconds, page = time.monotonic() - start, results / "report.html"
        wanted, hits = 5 if LONG else 1, 0
        for _ in range(20 * wanted):
            page.unlink()
            process = subprocess.Popen([program.PBSKIN, "report", str(results)], start_new_session=True, **QUIET)
            time.sleep(chance.uniform(0.0, 0.9 * seconds))
            os.killpg(process.pid, signal.SIGKILL)
            hits += process.wait() == -signal.SIGKILL
            self.assertTrue(not page.exists() or run_records.what_is_torn(page) is None)
            self.succeeds("report", results)
            self.assertEqual([path.name for path in results.iterdir() if path.name.startswith(".")], [])
            if hits == wanted:
                break
        self.assertEqual(hits, wanted)


if __name__ == "__main__":
    unittest.main()
