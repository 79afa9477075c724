"""Reference: the definition. A sweep expands to every combination once, with names that depend only on scene and keys; invalid ones are
refused with file, line, field, value and rule."""
import itertools
import pathlib
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(root / "experiments/sweeps"))

import scene_files  # noqa: E402
import sweep_file  # noqa: E402

GOOD = """schema = 1
scene = "limb_bend"
[set]
motion.frames = 3
deformers.use = ["lbs", "pbs"]
[grid]
pbs.k_stretch = [0.1, 0.2]
pbs.iterations = [1, 2, 3]
"""
REFUSED = {  # name: (replaced, by, line, part of the message)
    "no TOML": ("[grid]", "[grid", 6, "no TOML"),
    "a key twice": ("pbs.iterations", "pbs.k_stretch", 8, "no TOML"),
    "no schema": ("schema = 1\n", "", 1, "schema = None: expected 1"),
    "schema of the future": ("schema = 1", "schema = 2", 1, "schema = 2: expected 1"),
    "schema no number": ("schema = 1", "schema = true", 1, "schema = true: expected 1"),
    "no scene": ('scene = "limb_bend"\n', "", 1, "scene = None: expected a scene"),
    "scene no text": ('"limb_bend"', "3", 2, "scene = 3: expected a scene"),
    "scene file not there": ("limb_bend", "absent.toml", 2, 'scene = "absent.toml": No such file'),
    "unknown table": ("[set]", "[fixed]", 3, "fixed = "),
    "key without a table": ("motion.frames", "frames", 4, "set.frames = 3: expected a key of the scene"),
    "date": ("frames = 3", "frames = 2020-01-01", 4, "set.motion.frames = 2020-01-01: expected a finite number"),
    "not a number": ("frames = 3", "frames = nan", 4, "set.motion.frames = nan: expected a finite number"),
    "infinite in a list": ("[0.1, 0.2]", "[0.1, inf]", 7, "grid.pbs.k_stretch = [0.1, inf]: expected a finite number"),
    "no list": ("[1, 2, 3]", "24", 8, "grid.pbs.iterations = 24: expected a list"),
    "empty list": ("[1, 2, 3]", "[]", 8, "grid.pbs.iterations = []: expected a list"),
    "value twice": ("[1, 2, 3]", "[1, 2, 1]", 8, "grid.pbs.iterations = [1, 2, 1]: expected every value once"),
    "set and varied": ("pbs.iterations", "motion.frames", 8, "grid.motion.frames = [1, 2, 3]: is set for all runs"),
    "nothing varies": (GOOD[GOOD.index("[grid]"):], "", 1, "expected a [grid] or [[run]] tables"),
    "grid no table": (GOOD[GOOD.index("[set]"):], "grid = 3\n", 3, "grid = 3: expected a table"),
    "run no tables": ("[grid]", "[run]", 6, "expected [[run]] tables"),
    "runs of other keys": ("[grid]", "[[run]]\na.b = 1\n[[run]]\na.c = 1\n[grid]", 8,
                           'run = "a.c": expected the keys of the first [[run]]: a.b'),
    "run twice": ("[grid]", "[[run]]\na.b = 1\n[[run]]\na.b = 1\n[grid]", 8, "expected every run once"),
    "run of a key of the grid": ("[grid]", "[[run]]\npbs.iterations = 1\n[grid]", 7, "run.pbs.iterations = 1: is set for all runs"),
    "too many": ("[1, 2, 3]", str(list(range(500_001))), 6, "expected at most 1000000"),
    "batch of none": ("[grid]", "[output]\nbatch = 0\n[grid]", 7, "output.batch = 0: expected a whole number"),
    "batch no number": ("[grid]", "[output]\nbatch = true\n[grid]", 7, "output.batch = true: expected a whole number"),
    "rows of something": ("[grid]", '[output]\nrows = "bones"\n[grid]', 7, 'output.rows = "bones": expected deformers or frames'),
    "unknown output": ("[grid]", "[output]\ncolumns = 1\n[grid]", 7, "output.columns = 1: unknown key"),
}


class SweepFile(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name, "sweep.toml")

    def read(self, text):
        self.file.write_text(text, encoding="utf-8")
        return sweep_file.read(self.file)

    def test_every_combination_once_the_last_key_fastest(self):
        sweep = self.read(GOOD)
        expected = list(itertools.product(["0.1", "0.2"], ["1", "2", "3"]))
        self.assertEqual([tuple(run.varied.values()) for run in sweep.runs], expected)
        self.assertEqual(sweep.keys, ["pbs.k_stretch", "pbs.iterations"])
        self.assertEqual(sweep.runs[4].overrides,
                         ["motion.frames=3", 'deformers.use=["lbs", "pbs"]', "pbs.k_stretch=0.2", "pbs.iterations=2"])
        self.assertEqual(len({run.name for run in sweep.runs}), 6)

    def names(self, text):
        scene_files.sha256.cache_clear()
        sweep = self.read(text)
        return [run.name for run in sweep.runs], sweep.files

    def write(self, **texts):
        for name, text in texts.items():
            (self.file.parent / name).write_text(text)

    def expect_in_the_names(self, scene, *expected):
        """Expects these files, which a scene names itself or through another of them, and not other.csv."""
        self.write(**{"arm.toml": scene, "other.csv": "1"})
        before, files = self.names(GOOD.replace('"limb_bend"', '"arm.toml"'))
        self.assertEqual(sorted(files), sorted(expected))
        for changed in (*expected, "other.csv"):
            with (self.file.parent / changed).open("a") as file:
                file.write(" ")
            after, _ = self.names(GOOD.replace('"limb_bend"', '"arm.toml"'))
            self.assertEqual(after == before, changed == "other.csv", changed)
            before = after

    def test_files_that_the_scene_names_are_in_the_names(self):
        self.write(**{"arm.ele": "1", "arm.node": "1"})
        self.expect_in_the_names('[character]\nmesh = "arm.ele"\nbody = "none"\n[[list]]\nclip = "absent.bvh"\n', "arm.ele", "arm.node")

    def test_a_mesh_named_by_its_vertices(self):
        self.write(**{"arm.ele": "1", "arm.node": "1"})
        self.expect_in_the_names('[character]\nmesh = "arm.node"\n', "arm.ele", "arm.node")

    def test_the_buffers_of_a_gltf(self):
        """A buffer may have any name, used literally as by assimp; one is inside the file, and one does not exist."""
        uris = '{"uri": "skin.bin"}, {"uri": "a%20clip.dat"}, {"uri": "data:;base64,AAAA"}, {"uri": "absent.bin"}, {"byteLength": 4}'
        self.write(**{"arm.gltf": '{"buffers": [%s]}' % uris, "skin.bin": "1", "a%20clip.dat": "1", "arm.bin": "1"})
        self.expect_in_the_names('[character]\nmesh = "arm.gltf"\n', "arm.gltf", "skin.bin", "a%20clip.dat")

    def test_what_is_no_gltf(self):
        for text in ("", "[]", '{"buffers": 1}', '{"buffers": [1]}', '{"buffers": [{"uri": 1}]}'):
            with self.subTest(text):
                self.write(**{"arm.gltf": text})
                self.expect_in_the_names('[character]\nmesh = "arm.gltf"\n', "arm.gltf")

    def test_files_that_a_run_names_are_in_its_name(self):
        folder = self.file.parent
        (folder / "arm.toml").write_text("")
        (folder / "arm.csv").write_text("1")
        text = GOOD.replace('"limb_bend"', '"arm.toml"').replace("pbs.k_stretch = [0.1, 0.2]", 'skinning.weights = ["paper", "arm.csv"]')
        before, _ = self.names(text)
        (folder / "arm.csv").write_text("2")
        after, files = self.names(text)
        self.assertEqual((list(files), after[:3]), (["arm.csv"], before[:3]))
        self.assertFalse(set(after[3:]) & set(before[3:]))

    def test_a_built_in_scene_has_no_folder(self):
        (self.file.parent / "lbs").write_text("1")
        absolute = self.file.parent / "arm.csv"
        absolute.write_text("1")
        _, files = self.names(GOOD.replace("motion.frames = 3", f'skinning.weights = "{absolute}"'))
        self.assertEqual(list(files), [str(absolute)])

    def test_listed_runs_each_over_the_grid(self):
        sweep = self.read(GOOD + "[[run]]\nmotion.joint = 'a'\n[[run]]\nmotion.joint = 'b'\n")
        self.assertEqual(len(sweep.runs), 12)
        self.assertEqual(sweep.keys, ["motion.joint", "pbs.k_stretch", "pbs.iterations"])
        self.assertEqual([run.varied["motion.joint"] for run in sweep.runs], ['"a"'] * 6 + ['"b"'] * 6)

    def test_names_are_of_what_runs_not_of_the_file(self):
        names = {tuple(run.varied.values()): run.name for run in self.read(GOOD).runs}
        grown = self.read("# a note\n" + GOOD.replace("0.2]", "0.2, 0.3]").replace("[grid]", "[output]\nbatch = 2\n[grid]")).runs
        self.assertEqual(names, {key: run.name for run in grown if (key := tuple(run.varied.values())) in names})
        changes = ("frames = 3", "frames = 4"), ("limb_bend", "limb_twist")
        others = {run.name for change in changes for run in self.read(GOOD.replace(*change)).runs}
        self.assertFalse(others & set(names.values()))

    def test_scene_file_counts_by_what_is_in_it(self):
        scene = self.file.parent / "own.toml"
        text, found = GOOD.replace("limb_bend", "own.toml"), []
        for content in ("schema = 1\n", "schema = 1\n# other\n", "schema = 1\n"):
            scene.write_text(content)
            found.append([run.name for run in self.read(text).runs])
        self.assertEqual(found[0], found[2])
        self.assertFalse(set(found[0]) & set(found[1]))
        self.assertEqual(self.read(text).scene, str(scene.resolve()))

    def test_jobs_hold_every_run_once_in_order(self):
        sweep = self.read(GOOD + "[output]\nbatch = 4\n")
        self.assertEqual([len(batch) for batch in sweep.batches().values()], [4, 2])
        self.assertEqual([run for batch in sweep.batches().values() for run in batch], sweep.runs)

    def test_bad_sweeps_are_refused_where_they_are_bad(self):
        for name, (old, new, line, told) in REFUSED.items():
            with self.subTest(name):
                self.assertIn(old, GOOD)
                with self.assertRaises(sweep_file.SweepError) as caught:
                    self.read(GOOD.replace(old, new, 1))
                self.assertTrue(str(caught.exception).startswith(f"{self.file}:{line}: "), caught.exception)
                self.assertIn(told, str(caught.exception))

    def test_unreadable_files_are_refused(self):
        self.file.write_bytes(b"schema = 1\n\xff\xfe")
        for file, told in ((self.file, "UTF-8"), (self.file.parent / "absent.toml", "No such file"), (self.file.parent, "directory")):
            with self.subTest(told), self.assertRaises(sweep_file.SweepError) as caught:
                sweep_file.read(file)
            self.assertIn(told, str(caught.exception))

    def test_examples_are_sweeps(self):
        for example in sorted((root / "experiments/sweeps/examples").glob("*.toml")):
            with self.subTest(example.name):
                self.assertGreater(len(sweep_file.read(example).runs), 1)


if __name__ == "__main__":
    unittest.main()
