"""Inputs that shrink, vanish or are replaced while they are read or played. A file that changes while it is read gives
the result of the whole file, or is refused by name, at whatever moment it changes; each changed state by itself is
refused. A run whose clip vanishes or is replaced ends normally, and its record states the bytes that were read.
Reference: the results for the whole, unchanged file."""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import bad_case
import foreign_arm
import mesh_texts
import program
import run_records
import sound_files
from sound_files import COMMON, NOISE

ROUNDS = 3
CUTS = (0, 1 / 3, 1 / 2)
RUN = ["--set", "output.frames_every=2", "-o", "out"]
READ = {"x.vtu": (COMMON["arm.vtu"], ["measure", "x.vtu", "x.vtu", "--csv", "out/figures.csv"]),
        "x.obj": (mesh_texts.obj(200 * sound_files.CORNERS, sound_files.FACES),
                  ["mesh", "x.obj", "-o", "out/t.vtu", "--vertices", "150", "--wrap-alpha", "0.05"]),
        "y.vtu": (COMMON["arm.vtu"], ["run", "arm.toml", *RUN, "--set", "character.mesh=y.vtu"]),
        "y.skeleton.toml": (foreign_arm.SKELETON,
                            ["run", "arm.toml", *RUN, "--set", "character.skeleton=y.skeleton.toml"]),
        "x.bvh": (COMMON["good.bvh"], ["run", "clip.toml", *RUN, "--set", "motion.clip=x.bvh"]),
        "x.csv": (sound_files.WEIGHTS, ["run", "arm.toml", *RUN, "--set", "skinning.weights=x.csv"]),
        "x.toml": (COMMON["arm.toml"], ["run", "x.toml", *RUN])}


def put(path, content):
    """Replaces the file in one step, like a careful writer."""
    beside = path.with_suffix(".beside")
    beside.write_bytes(content)
    beside.replace(path)


def written(out):
    """The files that the program has written, and the bytes that it states to have read."""
    provenance = json.loads((out / "run.json").read_text())["provenance"] if (out / "run.json").exists() else {}
    return run_records.records(out), provenance.get("input_hashes")


def shrink(path, whole, chance):
    path.write_bytes(whole[: int(len(whole) * chance.choice(CUTS))])


def vanish(path, whole, chance):
    path.unlink()


def replace(path, whole, chance):
    put(path, NOISE)


def disturb(path, whole, way, stop, chance):
    while not stop.is_set():
        way(path, whole, chance)
        stop.wait(2e-3 * chance.random())
        put(path, whole)
        stop.wait(2e-2 * chance.random())


class ChangingFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder, self.chance = pathlib.Path(temporary.name), random.Random(2014)
        bad_case.make(self.folder, COMMON)

    def run_once(self, command):
        """(exit status, stderr, the files that it has written)"""
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir()
        process = subprocess.run([bad_case.PBSKIN, *command], cwd=self.folder, capture_output=True, text=True,
                                 timeout=240)
        return process.returncode, process.stderr, written(out) if process.returncode == 0 else None

    def expect_refused(self, name, status, told):
        self.assertEqual(status, 2, told)
        self.assertIn(name, told)
        self.assertEqual([word for word in bad_case.WORDS_OF_NO_USER if word in told], [], told)

    def disturbed(self, name, whole, command, way):
        """The program's messages and files while the input changes."""
        stop = threading.Event()
        disturber = threading.Thread(target=disturb, args=(self.folder / name, whole, way, stop, self.chance))
        disturber.start()
        try:
            return [self.run_once(command) for _ in range(ROUNDS)]
        finally:
            stop.set()
            disturber.join()

    def test_whole_or_refused(self):
        answers = []
        for name, (text, command) in READ.items():
            whole = text.encode()
            put(self.folder / name, whole)
            status, told, undisturbed = self.run_once(command)
            self.assertEqual(status, 0, told)
            for way in (shrink, vanish, replace):
                with self.subTest(name, way=way.__name__):
                    for status, told, records in self.disturbed(name, whole, command, way):
                        answers.append(status)
                        if status == 0:
                            self.assertEqual(records, undisturbed)
                        else:
                            self.expect_refused(name, status, told)
        self.assertEqual(set(answers), {0, 2}, "it was never disturbed, or always")


STEPS = 3000  # some seconds of work after the first frame is on disk


class ReplacedClip(foreign_arm.ArmTest):
    scene_text = foreign_arm.CLIP_SCENE % 100.0

    def setUp(self):
        super().setUp()
        foreign_arm.write_bvh(self.path("arm.bvh"), [step % 90 for step in range(STEPS)])
        self.succeeds("run", self.scene, "-o", self.path("whole"), "--set", "motion.duration_s=0.05")
        self.recorded = self.hash_in("whole")

    def hash_in(self, folder):
        return self.json(folder, "run.json")["provenance"]["input_hashes"]["arm.bvh"]

    def ends_after(self, change):
        """The run is stopped once its first frame is on disk, and continues after the change."""
        out = self.path("out")
        process = subprocess.Popen([program.PBSKIN, "run", self.scene, "-o", out, "--set", "output.frames=[0]",
                                    "--set", "output.frames_every=0"], stderr=subprocess.PIPE, text=True)
        while process.poll() is None and not os.path.exists(os.path.join(out, "frames", "pbs_000000.vtu")):
            time.sleep(0.001)
        process.send_signal(signal.SIGSTOP)
        self.assertFalse(os.path.exists(os.path.join(out, "run.json")), "the run was over before the change")
        change()
        process.send_signal(signal.SIGCONT)
        _, told = process.communicate(timeout=600)
        self.assertEqual(process.returncode, 0, told)
        self.assertEqual(self.hash_in("out"), self.recorded)

    def test_a_clip_that_is_gone(self):
        self.ends_after(lambda: os.unlink(self.path("arm.bvh")))

    def test_a_clip_that_is_replaced(self):
        def replace():
            foreign_arm.write_bvh(self.path("other.bvh"), [0.0, 1.0])
            os.replace(self.path("other.bvh"), self.path("arm.bvh"))

        self.ends_after(replace)


if __name__ == "__main__":
    bad_case.limit_address_space()
    unittest.main()
