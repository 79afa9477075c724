"""A full disk is an error without half-written files: exit status 2, the file and the reason named, every other file
complete. When there is space again, the same command, or --resume, ends with the records of an undisturbed run. A limit
on the size of a file (ulimit -f) simulates the disk at every file's own size; a small tmpfs is a real one, where it can
be mounted. Reference: the files of an undisturbed run."""
import os
import pathlib
import re
import resource
import shutil
import subprocess
import unittest

import foreign_arm
import mesh_texts
import program
import reliability
import run_records
import sound_files

CHECK = pathlib.Path(__file__).with_name("full_disk_check.toml").read_text()
LIMB = foreign_arm.SCENE.replace('mesh = "arm.msh"\nskeleton = "arm.skeleton.toml"', 'body = "limb"\nvertices = 610') \
    .replace('"elbow"', '"forearm"').replace('["lbs", "dqs", "pbs"]', '["lbs"]') + "[output]\nframes_every = 0\n"
FULL = r"File too large|No space left on device"


class FullDisk(foreign_arm.ArmTest):
    scene_text = foreign_arm.SCENE + "[output]\nframes_every = 2\n"

    def expect_refused(self, process, folder):
        """The file that could not be written, according to the message."""
        self.assertEqual(process.returncode, 2, process.stderr)
        self.assertRegex(process.stderr, FULL)
        refusal = next(line for line in process.stderr.splitlines() if re.search(FULL, line))
        named = pathlib.Path(next(word for word in refusal.split() if str(folder) in word).rstrip(":"))
        self.assertFalse(named.exists(), named)
        for path in run_records.files(folder):
            self.assertFalse(run_records.is_temporary(path), path)
            self.assertIsNone(run_records.what_is_torn(path))
        return named

    def limited(self, size, *arguments, **options):
        return program.run(*arguments, **options,
                           preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def refused_at_every_size(self, *sets):
        """The endings of files that could not be written, one for each size at which some file of the run does not fit.
        The size is nine tenths of the file's own, since wall times change a file by less than that."""
        whole, folder = pathlib.Path(self.path("whole")), pathlib.Path(self.path("out"))
        self.succeeds("run", self.scene, "-o", whole, *sets)
        sizes = sorted({path.stat().st_size for path in run_records.files(whole)})
        refused = []
        for size in sizes:
            refused.append(self.expect_refused(self.limited(9 * size // 10, "run", self.scene, "-o", folder, *sets),
                                               folder).suffix)
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
        self.assertEqual(set(frames), {".vtu"})  # the frames are written first and are the largest files
        count = len(tables + frames)
        reliability.tell("full_disk", "limits on a file's size: the file named, nothing half-written", count, count)

    def test_earlier_results_stay_where_a_run_finds_no_room(self):
        folder = pathlib.Path(self.path("out"))
        self.succeeds("run", self.scene, "-o", folder)
        earlier = {path: path.read_bytes() for path in run_records.files(folder)}
        size = (folder / "metrics.csv").stat().st_size // 2  # the frames are larger, and written before it
        self.assertEqual(self.limited(size, "run", self.scene, "-o", folder).returncode, 2)
        self.assertEqual({path: path.read_bytes() for path in run_records.files(folder)}, earlier)

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    @unittest.skipIf(b"__asan_init" in pathlib.Path(program.PBSKIN).read_bytes(),
                     "the address sanitizer reserves terabytes")
    def test_little_memory_ends_with_a_result_or_a_message(self):
        """Threads of OpenBLAS that find no memory ask for it for ever."""
        scene = self.write("newton.toml", pathlib.Path(self.scene).read_text())
        # A user who selects kernels: the library is loaded with the module alone.
        users = {"OPENBLAS_CORETYPE": "Prescott"}
        for megabytes, environment in [(100, {}), (150, {}), (150, users), (200, users), (250, {})]:
            limit = megabytes * 1_000_000
            ended = program.run("run", scene, "-o", self.path("newton"), "--set",
                                'deformers.use=["lbs","warped_newton"]', env=os.environ | environment,
                                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            self.assertIn(ended.returncode, (0, 2), ended.stderr)
            self.assertTrue(ended.returncode == 0 or "pbskin: " in ended.stderr, ended.stderr)

    def test_a_study_goes_on_where_there_is_room_again(self):
        whole, folder = pathlib.Path(self.path("whole")), pathlib.Path(self.path("out"))
        self.succeeds("reproduce", "momentum", "-o", whole)
        size = (whole / "momentum" / "limb" / "measurements.csv").stat().st_size
        self.expect_refused(self.limited(size - 1, "reproduce", "momentum", "-o", folder), folder)
        self.succeeds("reproduce", "momentum", "-o", folder, "--resume")
        self.assertEqual(run_records.records(folder), run_records.records(whole))

    def test_every_other_writer(self):
        """At 100 bytes, a limit that none of their files meets."""
        arm, bounds = self.path("arm.msh"), self.write("check.toml", CHECK)
        surface = self.write("good.off", mesh_texts.off(sound_files.CORNERS, sound_files.FACES))
        for name, arguments in {"figures.csv": ["measure", arm, arm, "--csv", self.path("figures.csv")],
                                "figures.xml": ["measure", arm, arm, "--junit", self.path("figures.xml")],
                                "tets.vtu": ["mesh", surface, "-o", self.path("tets.vtu"), "--vertices", 200,
                                             "--wrap-alpha", 0.05],
                                "bench.json": ["bench", "--quick", "-o", self.path("bench")],
                                "lbs_000000.vtu": ["check", "--bounds", bounds, "-o", self.path("check")]}.items():
            with self.subTest(name):
                self.assertEqual(self.expect_refused(self.limited(100, *arguments), pathlib.Path(self.folder)).name,
                                 name)

    def test_the_page(self):
        folder = pathlib.Path(self.path("out"))
        self.succeeds("run", self.scene, "-o", folder)
        self.succeeds("report", folder)
        page = folder / "report.html"
        size = page.stat().st_size
        page.unlink()
        self.assertEqual(self.expect_refused(self.limited(size // 2, "report", folder), folder), page)

    def test_the_cache_is_left_alone(self):
        """A body whose cache file cannot be written is made again the next time."""
        scene = self.write("limb.toml", LIMB)
        whole, cache = pathlib.Path(self.path("whole_cache")), pathlib.Path(self.path("cache"))
        self.succeeds("run", scene, "-o", self.path("whole"), env={**os.environ, "PBSKIN_CACHE": str(whole)})
        size = max(path.stat().st_size for path in run_records.files(whole))
        self.assertGreater(size, 2 * max(path.stat().st_size for path in run_records.files(self.path("whole"))))
        process = self.limited(9 * size // 10, "run", scene, "-o", self.path("out"),
                               env={**os.environ, "PBSKIN_CACHE": str(cache)})
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual([path for path in run_records.files(cache) if path.stat().st_size > 0], [])
        self.assertEqual(run_records.records(self.path("out")), run_records.records(self.path("whole")))

    def test_standard_output(self):
        arm = self.path("arm.msh")
        for arguments in (["list"], ["explain", "pbs.k_volume"], ["measure", arm, arm], ["--version"],
                          ["list", "--help"]):
            with self.subTest(arguments), open("/dev/full", "wb") as full:
                process = subprocess.run([program.PBSKIN, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
                self.assertEqual(process.returncode, 2)
                self.assertTrue(process.stderr.endswith("pbskin: standard output: cannot be written\n"), process.stderr)

    def test_a_disk_that_fills_up(self):
        disk = pathlib.Path(self.path("disk"))
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", disk],
                          capture_output=True).returncode != 0:
            self.skipTest("no tmpfs can be mounted here")
        self.addCleanup(subprocess.run, ["umount", disk], check=True)
        self.expect_refused(program.run("run", self.scene, "-o", disk / "out"), disk)
        subprocess.run(["mount", "-o", "remount,size=16m", disk], check=True)
        self.succeeds("run", self.scene, "-o", disk / "out")
        reliability.tell("full_disk_mounted", "a disk that fills up under `run` (tmpfs): the same, and finished once "
                                              "there is room", 1, 1)


if __name__ == "__main__":
    unittest.main()
