"""A full disk is an error with nothing half-written: exit status 2, the file and the reason named, every other file whole; where there is
room again the same command, or --resume, ends with the records of an undisturbed run. A limit on the size of a file (ulimit -f) stands for
the disk at every file's own size; a small tmpfs is one, where it can be mounted. Truth: what an undisturbed run leaves."""
import pathlib
import re
import resource
import shutil
import subprocess
import unittest

import foreign_arm
import program
import reliability
import run_records

FULL = r"File too large|No space left on device"


class FullDisk(program.ProgramTest):
    def setUp(self):
        super().setUp()
        foreign_arm.write_msh(self.path("arm.msh"), *foreign_arm.mesh((10, 2, 2)))
        self.write("arm.skeleton.toml", foreign_arm.SKELETON)
        self.scene = self.write("arm.toml", foreign_arm.SCENE + "[output]\nframes_every = 2\n")

    def expect_refused(self, process, folder):
        """The file that could not be written, by what is said."""
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertRegex(process.stderr, FULL)
        refusal = next(line for line in process.stderr.splitlines() if re.search(FULL, line))
        named = pathlib.Path(next(word for word in refusal.split() if str(folder) in word).rstrip(":"))
        self.assertFalse(named.exists(), named)
        for path in run_records.files(folder):
            self.assertFalse(run_records.is_temporary(path), path)
            self.assertIsNone(run_records.what_is_torn(path))
        return named

    def limited(self, size, *arguments):
        return program.run(*arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def refused_at_every_size(self, *sets):
        """The endings of files that could not be written, one a size at which some file of the run does not fit: nine tenths of its own,
        which its wall times change by less."""
        whole, folder = pathlib.Path(self.path("whole")), pathlib.Path(self.path("out"))
        self.succeeds("run", self.scene, "-o", whole, *sets)
        sizes = sorted({path.stat().st_size for path in run_records.files(whole)})
        refused = []
        for size in sizes:
            refused.append(self.expect_refused(self.limited(9 * size // 10, "run", self.scene, "-o", folder, *sets), folder).suffix)
            self.assertFalse((folder / "run.json").exists())
        self.succeeds("run", self.scene, "-o", folder, *sets)
        self.assertEqual(run_records.records(folder), run_records.records(whole))
        return refused

    def test_every_writer_of_a_run(self):
        tables = self.refused_at_every_size("--set", "output.frames_every=0")
        self.assertEqual(set(tables), {".csv", ".json"})
        for name in ("whole", "out"):
            shutil.rmtree(self.path(name))
        frames = self.refused_at_every_size()
        self.assertEqual(set(frames), {".vtu"})  # they come first and are the largest
        count = len(tables + frames)
        reliability.tell("full_disk", "sizes of a full disk: the file named, nothing half-written", count, count)

    def test_a_study_goes_on_where_there_is_room_again(self):
        whole, folder = pathlib.Path(self.path("whole")), pathlib.Path(self.path("out"))
        self.succeeds("reproduce", "momentum", "-o", whole)
        size = (whole / "momentum" / "limb" / "measurements.csv").stat().st_size
        self.expect_refused(self.limited(size - 1, "reproduce", "momentum", "-o", folder), folder)
        self.succeeds("reproduce", "momentum", "-o", folder, "--resume")
        self.assertEqual(run_records.records(folder), run_records.records(whole))

    def test_figures_of_measure_and_meshes(self):
        self.assertIn("figures.csv", self.expect_refused(
            self.limited(100, "measure", self.path("arm.msh"), self.path("arm.msh"), "--csv", self.path("figures.csv")), self.folder).name)

    def test_a_disk_that_fills_up(self):
        disk = pathlib.Path(self.path("disk"))
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk], capture_output=True).returncode != 0:
            self.skipTest("no tmpfs can be mounted here")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        self.expect_refused(program.run("run", self.scene, "-o", disk / "out"), disk)
        subprocess.run(["mount", "-o", "remount,size=16m", disk], check=True)
        self.succeeds("run", self.scene, "-o", disk / "out")


if __name__ == "__main__":
    unittest.main()
