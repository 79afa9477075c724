"""Deformers of the user's own: the examples of experiments/deformers/external/README.md, run as it describes, and every
way in which a program or a library can fail. Reference: the formulas of the examples, computed here from what pbskin
writes for a program, and the frames of pbskin's own LBS. Tolerance: a thousand roundings of the largest coordinate, for
sums over fewer than a hundred bones and neighbours."""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import unittest

import numpy
from vtk.util.numpy_support import vtk_to_numpy

import foreign_arm
import program
import written_frames

FOLDER = pathlib.Path(program.SOURCE) / "experiments/deformers/external"
EXAMPLE = (FOLDER / "examples/smoothed_skinning.py").read_text()
PAGE = (FOLDER / "README.md").read_text()
TABLES = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
COMMANDS = [line.split("  #")[0].strip() for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
            for line in block.splitlines()] + re.findall(r"`(pbskin [^`]*)`", PAGE.replace("\n", " "))
COMPILE = re.search(r"^cc .*$", PAGE, re.MULTILINE)[0]
LIMB = ('body = "limb"\nvertices = 300\n[motion]\njoint = "forearm"\naxis = [0.0, 0.0, 1.0]\nangle_deg = 90.0\n'
        'frames = 4\n')
HUMAN = 'body = "human"\nvertices = 600\n[motion]\nclip = "01_01.bvh"\nrate_hz = 25.0\nduration_s = 0.2\n'
SETTINGS = foreign_arm.PBS + "[output]\nframes_every = 1\n"
ENVIRONMENT = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"]}  # Debian's python3 has numpy
KEEP = "\nimport shutil\nshutil.copytree(folder, %r, dirs_exist_ok=True)\n"  # for the end of a Python deformer
TOLERANCE = 1000 * numpy.finfo(float).eps

LIBRARY = pathlib.Path(__file__).with_name("own_deformer.c.in").read_text()
SOUND = {"version": "PBSKIN_DEFORMER_VERSION", "made": "&vertices", "advance": "advance", "position": "x[i] + 1.0",
         "status": "0"}


class Exchanged:
    """What pbskin wrote for a program, in the shapes of the README."""

    def __init__(self, folder):
        facts = json.loads((folder / "character.json").read_text())
        vertices, self.bones, poses = facts["vertices"], len(facts["bones"]), facts["poses"]
        self.rest = numpy.fromfile(folder / "rest.f64", "<f8").reshape(vertices, 3)
        self.tets = numpy.fromfile(folder / "tets.i32", "<i4").reshape(facts["tets"], 4)
        self.weights = numpy.fromfile(folder / "weights.f64", "<f8").reshape(vertices, self.bones)
        self.poses = numpy.fromfile(folder / "poses.f64", "<f8").reshape(poses, self.bones, 3, 4)

    def of_bone(self, pose, bone):
        """All rest points, carried by one bone."""
        return self.rest @ self.poses[pose, bone, :, :3].T + self.poses[pose, bone, :, 3]

    def blended(self, pose):
        return sum(self.weights[:, bone, None] * self.of_bone(pose, bone) for bone in range(self.bones))

    def smoothed(self, pose, steps=4):
        neighbours = [set() for _ in self.rest]
        for tet in self.tets:
            for vertex in tet:
                neighbours[vertex].update(set(tet) - {vertex})
        moved = self.blended(pose) - self.rest
        for _ in range(steps):
            moved = numpy.array([moved[sorted(others)].mean(axis=0) for others in neighbours])
        return self.rest + moved

    def rigid(self, pose):
        heaviest = self.weights.argmax(axis=1)
        return numpy.array([self.of_bone(pose, bone)[vertex] for vertex, bone in enumerate(heaviest)])


class OwnDeformer(program.ProgramTest):
    def scene(self, body, tables):
        return self.write("scene.toml", f"schema = 1\n[character]\n{body}{tables}{SETTINGS}")

    def frame(self, deformer, frame):
        """Points and tets."""
        grid = written_frames.read(self.path("out", "frames", f"{deformer}_{frame:06d}.vtu"))
        return written_frames.points(grid), written_frames.tets(grid)

    def compiled_example(self):
        """The library of the README, and where a program may keep what it was given."""
        subprocess.run(COMPILE.replace("libmine.so", self.path("libmine.so")).split(), cwd=FOLDER, check=True)
        return pathlib.Path(self.path("kept"))

    def compiled(self, name="libmine.so", **changes):
        source = self.write("mine.c", LIBRARY % {**SOUND, **changes})
        subprocess.run(["cc", "-shared", "-fPIC", "-I", FOLDER, source, "-o", self.path(name)], check=True)
        return self.path(name)

    def run_scene(self, status=0, **expected):
        return self.ends(status, "run", self.path("scene.toml"), "-o", self.path("out"), env=ENVIRONMENT, **expected)

    def expect_equal(self, positions, expected):
        self.assertEqual(positions.shape, expected.shape)
        numpy.testing.assert_allclose(positions, expected, rtol=0, atol=TOLERANCE * numpy.abs(expected).max())

    def needs_the_human(self):
        if not os.path.isdir("/usr/share/assimp/models/BVH"):
            self.skipTest("the human's clip comes with assimp-testmodels")

    def python_example(self, body, frames):
        kept = pathlib.Path(self.path("kept"))
        self.write("my_deformer.py", EXAMPLE + KEEP % str(kept))
        self.scene(body, TABLES[0] + '[reference]\nname = "pbs"\n')
        self.run_scene()
        given = Exchanged(kept)
        self.assertEqual(len(given.poses), frames)
        for frame in range(frames):
            positions, tets = self.frame("mine", frame)
            numpy.testing.assert_array_equal(tets, given.tets)
            self.expect_equal(self.frame("lbs", frame)[0], given.blended(frame))
            self.expect_equal(positions, given.smoothed(frame))
        self.assertGreater(numpy.abs(positions - given.blended(frames - 1)).max(), 0.001)
        run = self.json("out", "run.json")
        self.assertIn("mine", run["state_hash"])
        self.assertEqual([one["label"] for one in run["scene"]["runs"]], ["lbs", "pbs", "mine"])
        self.succeeds("report", self.path("out"))
        page = self.read("out", "report.html")
        figure = page.split('id="figure-error-against-time"')[1].split("</figure>")[0]
        for label in ("LBS", "mine"):
            self.assertIn(f">{label}<", figure)
        self.assertIn('<th scope="row">mine</th>', page)

    # The examples.

    def test_the_python_example_on_the_limb(self):
        self.python_example(LIMB, 4)

    def test_the_page_of_a_run_with_every_deformer_is_made(self):
        listed = [line.split()[0] for line in self.succeeds("list", "deformers").stdout.splitlines()[1:]]
        names = [name for name in listed if name not in ("fem", "external", "correctives")]  # these have a table each
        self.assertIn("xpbd_small_steps", names)
        self.scene(LIMB, f"[deformers]\nuse = {json.dumps(names)}\n")
        self.run_scene()
        self.succeeds("report", self.path("out"))
        self.assertIn('<th scope="row">', self.read("out", "report.html"))

    def test_the_python_example_on_a_real_body(self):
        self.needs_the_human()
        self.python_example(HUMAN, 6)

    def test_the_library_of_the_readme(self):
        kept = self.compiled_example()
        self.write("keep.py", "import sys, pathlib\nfolder = pathlib.Path(sys.argv[-1])\n" + KEEP % str(kept)
                   + "import numpy\nfacts = numpy.fromfile(folder / 'rest.f64')\n"
                   + "numpy.tile(facts, 4).tofile(folder / 'positions.f64')\n")
        kept_table = '[[external]]\nname = "keep"\ncommand = ["python3", "keep.py"]\n'
        self.scene(LIMB, TABLES[1] + kept_table + '[deformers]\nuse = ["mine", "keep"]\n')
        self.run_scene()
        given = Exchanged(kept)
        for frame in range(4):
            self.expect_equal(self.frame("mine", frame)[0], given.rigid(frame))
            numpy.testing.assert_array_equal(self.frame("keep", frame)[0], given.rest)

    def test_a_library_with_memory_gets_every_time_step(self):
        """Each call moves the body by a metre. The clip has four steps of 10 ms per frame."""
        self.needs_the_human()
        self.compiled()
        for has_memory, calls in (("true", 4 * 5 + 1), ("false", 5 + 1)):
            self.scene(HUMAN, TABLES[1] + f'has_memory = {has_memory}\n[deformers]\nuse = ["mine"]\n')
            self.run_scene()
            rest = self.frame("mine", 0)[0] - 1.0
            self.expect_equal(self.frame("mine", 5)[0], rest + calls)

    # The study of error against run time.

    def reproduce(self, *arguments):
        return self.succeeds("reproduce", "work_precision", "--only", "limb", "-o", self.path("out"), "--external",
                             self.path("mine.toml"), *arguments, env=ENVIRONMENT)

    def run_commands_of_the_readme(self):
        """Each command of the study with FOLDER and DIR in place; the three minutes of two bodies are not computed, but
        their plan is printed. The other tests call the commands for scenes. Returns what the run of one body prints."""
        of_scenes = {COMPILE, "pbskin run SCENE.toml -o DIR", "pbskin report DIR"}
        commands = [command for command in COMMANDS if command not in of_scenes]
        self.assertEqual(len(commands), 3, commands)
        printed = {}
        for command in sorted(commands, key=lambda command: "make_all.py" in command):  # the figure follows the run
            words = command.replace("FOLDER", self.folder).replace("DIR", self.path("out")).replace(
                "pbskin ", f"{program.PBSKIN} ").split()
            words += ["--plan"] if "reproduce" in words and "--only" not in words else []
            process = subprocess.run(words, cwd=program.SOURCE, env=ENVIRONMENT, capture_output=True, text=True)
            self.assertEqual(process.returncode, 0, f"{command}: {process.stdout}{process.stderr}")
            printed[command] = process.stderr + process.stdout
        return next(text for command, text in printed.items() if "--only limb" in command)

    def runs_to_do(self):
        return len(json.loads(self.reproduce("--resume", "--plan").stdout))

    def error_joint_pct(self, positions, pose, member):
        """From the exported reference, by the formula of its manual."""
        reference = written_frames.read(self.path("kit", pose, f"{member}.vtu"))
        field = {name: vtk_to_numpy(reference.GetPointData().GetArray(name))
                 for name in ("displacement", "blended", "at_tips", "lumped_volume_m3", "bone_distance_m")}
        at = (field["blended"] == 1) & (field["at_tips"] == 0)
        mass, distance_m = field["lumped_volume_m3"][at], field["bone_distance_m"][at]
        apart = (positions - written_frames.points(reference) - field["displacement"])[at]
        return 100 * numpy.sqrt((mass * (apart ** 2).sum(axis=1)).sum() / mass.sum()) * mass.sum() / (
            mass * distance_m).sum()

    def test_the_study_of_error_against_run_time_has_rows_for_it(self):
        """The example of the README, the same example without smoothing, which is LBS and states times of 1, 2, 3 and 4
        ms for the turns of each pose (slow: 100 to 400 ms), and the library of the README. The commands are those of
        the README. Reference: the shapes of LBS, the exported references, and the median of the times after the first
        (2, 3 and 4 ms). Tolerance: references are exported with ten digits."""
        text = EXAMPLE
        kept = pathlib.Path(self.path("kept"))
        blended = text.replace("in range(4):", "in range(0):").replace("time.perf_counter() - start",
                                                                       "0.001 * (1 + len(seconds) % 4)")
        self.write("my_deformer.py", text)
        self.write("lbs.py", blended + KEEP % str(kept))
        self.write("slow.py", blended.replace("0.001 *", "0.1 *"))
        self.compiled_example()
        example = re.search(r"```toml\n(schema = 1.*?)```", PAGE, re.DOTALL)[1]
        tables = (example + '[[external]]\nname = "blended"\ncommand = ["python3", "lbs.py"]\n'
                  + '[[external]]\nname = "slow"\ncommand = ["python3", "slow.py"]\n'
                  + '[[external]]\nname = "rigid"\nlibrary = "libmine.so"\n')
        self.write("mine.toml", tables)
        screen = self.run_commands_of_the_readme()
        self.assertRegex(screen, r"(?m)^slow: 300 ms per frame, \d+ % of LBS's error \[\d+, \d+\] in 8 poses; "
                                 r"with at most 10 ms: DQS \d+ %, delta mush \d+ %, PBS \d+ %; too slow for 0\.1 to "
                                 r"10 ms\.$")
        self.assertLess(screen.index("first answer, 4 poses of limb: slow: 300 ms"), screen.index("1 of 1 runs"))
        self.assertIn(">slow<", self.read("out", "figures", "error_against_time.svg"))
        self.succeeds("report", self.path("out"))
        self.assertIn("slow leaves ", self.read("out", "report.html"))
        given = Exchanged(kept)
        rows = self.rows("out", "work_precision", "limb", "points.csv")
        own = {name: [row for row in rows if row["method"] == name] for name in ("mine", "blended", "rigid")}
        self.assertEqual({name: {row["clock"] for row in of} for name, of in own.items()},
                         {"mine": {"own"}, "blended": {"own"}, "rigid": {"processor"}})
        poses = [row["pose"] for row in own["blended"]]
        self.assertEqual(len(poses), 9)  # eight movements and a fold
        self.assertEqual(len(given.poses), 4 * len(poses))
        for turn in range(len(given.poses)):
            numpy.testing.assert_array_equal(given.poses[turn], given.poses[turn // 4 * 4 + turn % 2])
        compared = ("limb_twist_60", "limb_bend_75")
        self.succeeds("references", "export", *compared, "-o", self.path("kit"))
        for pose in compared:
            place = poses.index(pose)
            for member in ("smooth", "rigid_capsules", "held_parts"):
                error, smoothed = (float(own[name][place][f"{member}_pct"]) for name in ("blended", "mine"))
                self.assertAlmostEqual(error, self.error_joint_pct(given.blended(4 * place), pose, member),
                                       delta=1e-6 * error)
                self.assertGreater(abs(smoothed - error), 1e-3 * error)
        for row in own["blended"]:
            self.assertAlmostEqual(float(row["ms"]), 3.0, delta=1e-12)
        methods = [row for row in self.rows("out", "work_precision", "methods.csv") if row["method"] == "blended"]
        self.assertEqual([(row["table"], float(row["budget_ms"])) for row in methods],
                         [("known", 10.0), ("known", math.inf),
                           ("guessed", 10.0), ("guessed", math.inf)])
        for row in methods:
            self.assertAlmostEqual(float(row["ms"]), 3.0, delta=1e-12)
            self.assertEqual(row["within"], "doubled")
        subprocess.run([sys.executable, "-B", pathlib.Path(program.SOURCE) / "paper_figures/make_pages.py",
                        self.path("out")], check=True)
        page = self.read("out", "work_precision", "work_precision.md")
        self.assertIn("- `rigid`: processor time", page)
        self.assertIn("- `blended`: the times that the program states", page)
        self.assertEqual(self.runs_to_do(), 0)
        renamed = tables.replace('"blended"', '"unsmoothed"')
        for name, whole, other in (("my_deformer.py", text, text + "\n"), ("mine.toml", tables, renamed),
                                   ("mine.toml", tables, example)):
            self.write(name, other)
            self.assertEqual(self.runs_to_do(), 1)
            self.write(name, whole)
            self.assertEqual(self.runs_to_do(), 0)

    def write_table(self, name, keys):
        return self.write(name, f'schema = 1\n[[external]]\nname = "mine"\n{keys}\n')

    def test_what_the_study_refuses_before_it_computes(self):
        os.mkdir(self.path("sub"))
        self.script("mine.sh", "")
        mine = self.write_table("mine.toml", 'command = ["no_such_program"]')
        crash = self.write_table("crash.toml", 'library = "libmine.so"')
        sound = self.write_table("sound.toml", 'command = ["python3", "any.py"]')
        self.write_table("sub/d.toml", 'command = ["./mine.sh"]')
        self.compiled(version="*(volatile int*)0")
        crashed = r".*crash\.toml:4: external\.0\.library = libmine\.so: cannot be loaded: .*signal 11"
        a_run = r"--external = .*\.toml: expected a run of work_precision among the runs"
        for words, *arguments in (
                (r".*mine\.toml:4: external\.0\.command = .*no_such_program.*: cannot be started: No such",
                 "work_precision", "--external", mine),
                (r"sub/d\.toml:4: external\.0\.command = .*\./mine\.sh.*: cannot be started: No such", "work_precision",
                 "--external", "sub/d.toml"),
                (crashed, "work_precision", "--external", crash), (crashed, "work_precision", "--external", crash,
                                                                   "--plan"),
                (a_run, "volume", "--external", mine), (a_run, "work_precision", "volume", "--external", sound,
                                                        "--only", "limb_twist"),
                ("--external: expected a file", "work_precision", "--external", ""),
                (r".*none\.toml: cannot be read", "work_precision", "--external", self.path("none.toml")),
                (r"--only = limb_bend_60: no such run; expected one of limb", "work_precision", "--only",
                 "limb_bend_60")):
            with self.subTest(words):
                process = self.ends(2, "reproduce", *arguments, "-o", self.path("out"), cwd=self.folder)
                self.assertRegex(process.stderr, rf"^pbskin: {words}.*\n$")
                self.assertFalse(os.path.exists(self.path("out")))

    # Failures: the scene, the deformer, its command or library, and the rule.

    def expect_refused(self, key, value, rule):
        process = self.run_scene(2)
        self.assertRegex(process.stderr, rf"^pbskin: .*scene\.toml: mine\.{key} = .*{re.escape(value)}.*: "
                                         rf".*{re.escape(rule)}.*\n$")
        self.assertFalse(os.path.exists(self.path("out", "run.json")))

    def expect_program_refused(self, script, rule, mode=0o755):
        self.script("mine.sh", script + "\n", mode)
        self.scene(LIMB, '[[external]]\nname = "mine"\ncommand = ["mine.sh"]\n[deformers]\nuse = ["lbs", "mine"]\n')
        self.expect_refused("command", "mine.sh", rule)

    def test_a_program_that_fails(self):
        self.expect_program_refused("exit 3", "ended with status 3: expected status 0")
        self.expect_program_refused("echo one; echo two; exit 1", "ended with status 1: expected status 0; "
                                                                  "its last line: two")
        self.expect_program_refused("kill -9 $$", "ended by a signal")
        self.expect_program_refused("exit 0", "cannot be started: Permission denied", mode=0o644)
        self.expect_program_refused("exit 0", "positions.f64: missing: expected the program to write it")
        self.expect_program_refused("echo 1234567 > $1/positions.f64", "positions.f64: bytes = 8: expected ")

    def test_an_exception_in_python_is_named(self):
        self.write("my_deformer.py", "raise ValueError('no such bone')\n")
        self.scene(LIMB, TABLES[0])
        self.expect_refused("command", "my_deformer.py", "its last line: ValueError: no such bone")

    def test_positions_that_are_not_finite_are_a_breakdown(self):
        writing = "numpy.array(positions).tofile"
        self.write("my_deformer.py", EXAMPLE.replace(writing, "positions[2][5] = numpy.nan\n" + writing))
        self.scene(LIMB, TABLES[0])
        process = self.run_scene(3)
        self.assertRegex(process.stderr, "numerical breakdown: mine is .*frame 2.*vertex 5")
        self.assertEqual(self.json("out", "run.json")["outcome"]["breakdowns"], {"mine": [2]})
        page = self.succeeds("report", self.path("out"))
        self.assertNotIn("Traceback", page.stderr)
        self.assertIn("mine is ", self.read("out", "report.html"))

    def test_a_library_that_fails(self):
        self.scene(LIMB, TABLES[1] + '[deformers]\nuse = ["mine"]\n')
        self.expect_refused("library", "libmine.so", "cannot be loaded: ")
        self.write("libmine.so", "no library")
        self.expect_refused("library", "libmine.so", "cannot be loaded: ")
        for changes, rule in (({"advance": "step"}, "has no function pbskin_deformer_advance"),
                              ({"version": "7"}, "was compiled for version 7 of pbskin_deformer.h: expected version 1"),
                              ({"made": "0"}, "pbskin_deformer_create returned null: expected a deformer"),
                              ({"status": "4"}, "pbskin_deformer_advance returned 4: expected 0")):
            os.remove(self.path("libmine.so"))
            self.compiled(**changes)
            self.expect_refused("library", "libmine.so", rule)

    def test_a_table_without_or_with_both(self):
        for keys in ("", 'command = ["a"]\nlibrary = "b"\n'):
            self.scene(LIMB, f'[[external]]\nname = "mine"\n{keys}[deformers]\nuse = ["mine"]\n')
            process = self.run_scene(2)
            self.assertRegex(process.stderr, r"scene\.toml.*external.*command.*expected either a command or a library")


if __name__ == "__main__":
    unittest.main()
