"""`pbskin check` as a CI server runs it: exit status, JUnit (read back by Python's own parser), GitHub's annotations
and summary, and the baseline. Reference: the contract in experiments/command_line/README.md; whether a bound holds is
decided here, from the values of the frames. The steps of .github/workflows/volume.yml, and of the example for another
repository, work as described: those of pbskin are run in a folder of their own by the shell of a container's job, and
those that build name functions, presets and targets that exist. Reference: the files themselves."""
import csv
import json
import os
import pathlib
import re
import subprocess
import tomllib
import unittest
import xml.etree.ElementTree as ElementTree

import foreign_arm
import program
import rig_files
import run_records

BOUNDS = pathlib.Path(__file__).with_name("check_bounds.toml").read_text()
REFUSED = tomllib.loads(pathlib.Path(__file__).with_name("check_refused.toml").read_text())["rows"]
VOLUME = ("arm", 'volume, 100 % <of> & "rest"')


class Check(foreign_arm.ArmTest):
    def setUp(self):
        super().setUp()
        self.bounds = self.write("check.toml", BOUNDS % "-60.0")
        self.baseline = self.path("baseline.csv")
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("GITHUB_")}

    def check(self, status, *arguments, **environment):
        return self.ends(status, "check", "--bounds", self.bounds, "-o", self.path("out"), *arguments,
                         env={**self.environment, **environment})

    def volume_changes(self):
        return [float(row["volume_change_pct"]) for row in self.rows("out", "arm", "metrics.csv")
                if row["deformer"] == "lbs"]

    def message_of(self, kind, *key):
        """The message of the failure or error of a case."""
        return run_records.junit_cases(self.path("volume.xml"))[key].find(kind).get("message")

    def write_bounds_with(self, *settings):
        self.write("check.toml", (BOUNDS % "-60.0").replace('name = "arm"', f'name = "arm"\nset = {list(settings)}'))

    def altered_baseline(self, column, change):
        """Replaces a value in the row of pbs in frame 3."""
        rows = self.rows("baseline.csv")
        for row in rows:
            if (row["deformer"], row["frame"]) == ("pbs", "3"):
                row[column] = repr(change(float(row[column])))
        with open(self.baseline, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def test_own_bounds_and_baseline_hold_whatever_lies_in_the_folder(self):
        os.mkdir(self.path("experiments"))
        self.write(os.path.join("experiments", "limb_twist"), "no scene")
        process = program.run("check", "-o", "own", "--junit", "own.xml", "--require-all", env=self.environment,
                              cwd=self.folder)
        # Meshes of another CGAL, whose baselines must differ.
        other_meshes = run_records.scenes_of_another_mesh(self.path("own"))
        failed = run_records.failed_cases(self.path("own.xml"))
        self.assertEqual(failed, run_records.baselines_of(other_meshes, self.path("own.xml")), process.stderr)
        self.assertEqual(process.returncode, 1 if failed else 0, process.stderr)
        self.assertEqual(self.json("own", "check.json")["outcome"]["FAILS"], len(failed))

    def test_a_bound_that_holds(self):
        process = self.check(0, "--junit", self.path("volume.xml"))
        # the arm's tets are reoriented, with a warning
        self.assertEqual(process.stderr.count("pbskin:"), process.stderr.count("pbskin: warning:"), process.stderr)
        self.assertIsNone(run_records.junit_cases(self.path("volume.xml"))[VOLUME].find("failure"))
        root = ElementTree.parse(self.path("volume.xml")).getroot()
        self.assertEqual([root.get(key) for key in ("tests", "failures", "errors", "skipped")], ["2", "0", "0", "0"])
        self.assertGreater(float(root.get("time")), 0.0)

    def test_a_bound_tightened_until_it_fails_names_the_frame(self):
        self.check(0)
        change = self.volume_changes()
        worst = change.index(min(change))
        self.assertGreater(worst, 0)
        self.write("check.toml", BOUNDS % (change[worst] + 1e-3))
        process = self.check(1, "--junit", self.path("volume.xml"), "--github",
                             GITHUB_STEP_SUMMARY=self.path("summary.md"))
        failure = self.message_of("failure", *VOLUME)
        found = re.match(r"frame (\d+): volume_change_pct of lbs = (\S+) %, expected at least", failure)
        self.assertEqual(int(found[1]), worst)
        self.assertAlmostEqual(float(found[2]), change[worst], places=3)
        self.assertIn(failure, process.stderr)
        annotation = "::error file=%s,line=5,title=arm volume%%2C 100 %%25 <of> & \"rest\"::%s" % (
            self.bounds, failure.replace("%", "%25"))
        self.assertIn(annotation, process.stdout.splitlines())
        self.assertIn("| FAILS | arm |", self.read("summary.md"))

    def test_on_github_annotations_come_by_themselves(self):
        self.write("check.toml", BOUNDS % "0.5")
        self.assertNotIn("::error", self.check(1).stdout)
        self.assertIn("::error", self.check(1, GITHUB_ACTIONS="true").stdout)

    def test_another_accuracy_or_count_fails_and_wall_time_does_not(self):
        self.check(0, "--write-baseline", self.baseline)
        kept = self.read("baseline.csv")
        for column, change in (("volume_change_pct", lambda v: v + 2e-4), ("tets", lambda v: v + 1),
                               ("inverted_tets", lambda v: v + 1), ("j_min", lambda v: float("nan"))):
            self.altered_baseline(column, change)
            self.check(1, "--baseline", self.baseline, "--junit", self.path("volume.xml"))
            failure = self.message_of("failure", "arm", "baseline of pbs")
            self.assertRegex(failure, r"^frame 3: %s was .*, is " % column)
            self.write("baseline.csv", kept)
        self.altered_baseline("volume_change_pct", lambda v: v + 5e-5)  # half of its tolerance
        self.check(0, "--baseline", self.baseline)
        self.altered_baseline("step_ms", lambda v: 1e3 * v)
        process = self.check(0, "--baseline", self.baseline)
        self.assertRegex(process.stdout, r"wall time of pbs +\S+ ms per step, \S+ of the baseline's")

    def test_a_report_that_cannot_be_written_is_refused_before_the_work(self):
        for arguments, environment in ((("--junit", self.path("none", "x.xml")), {}),
                                       (("--write-baseline", self.path("none", "x.csv")), {}),
                                       (("--github",), {"GITHUB_STEP_SUMMARY": self.path("none", "summary.md")})):
            self.check(2, *arguments, **environment, says="cannot be written")
            self.assertFalse(os.path.exists(self.path("out", "arm")), arguments)
        self.check(0, "--junit", self.path("out", "volume.xml"))  # in the folder that the check creates

    def test_bounds_whose_name_is_not_utf8_lose_no_record(self):
        own = os.fsdecode(os.fsencode(self.path("che")) + b"\xff.toml")
        os.rename(self.bounds, own)
        self.bounds = own
        self.check(0)
        self.assertEqual(self.json("out", "check.json")["scenes"][0]["cases"][0]["file"], self.path("che\ufffd.toml"))

    def test_a_deformer_or_frame_that_is_gone_fails(self):
        self.check(0, "--write-baseline", self.baseline)
        for change in ('deformers.use=["lbs"]', "motion.frames=4"):
            self.write_bounds_with(change)
            self.check(1, "--baseline", self.baseline)

    def test_bad_baselines_and_bounds(self):
        self.check(0, "--write-baseline", self.baseline)
        kept, good = self.read("baseline.csv"), BOUNDS % "-60.0"
        for text, message in (("", "the file is empty"),
                              ("a,b\n1,2\n", "missing: expected a file of `pbskin check --write-baseline`"),
                              (kept[:-20], "cut off"), (kept.replace("arm,pbs,3,", "arm,pbs,three,"), "three"),
                              (kept + kept.splitlines()[1] + "\n", "expected it once: line 2 has it too")):
            self.write("baseline.csv", text)
            process = self.check(2, "--baseline", self.baseline)
            self.assertRegex(process.stderr, r"pbskin: \S*baseline\.csv.*" + re.escape(message))
        self.check(2, "--baseline", self.path("none.csv"))
        for old, new, message in REFUSED:
            self.write("check.toml", good.replace(old, new))
            process = self.check(2)
            self.assertRegex(process.stderr, message)

    def test_a_scene_without_its_body_is_left_out_and_said_so(self):
        self.write("check.toml", BOUNDS % "-60.0" + '[[check.scene]]\nscene = "man_01_01"\nneeds = "man"\n')
        empty = {"PBSKIN_CACHE": self.path("cache")}  # fetched bodies are in the cache
        self.check(2, "--junit", self.path("volume.xml"), "--github", "--require-all", **empty)
        process = self.check(0, "--junit", self.path("volume.xml"), "--github", **empty)
        cases = run_records.junit_cases(self.path("volume.xml"))
        self.assertEqual([key for key, case in cases.items() if case.find("skipped") is not None],
                         [("man_01_01", "runs")])
        self.assertIn("::warning file=", process.stdout)

    def test_poses_that_are_not_reached_and_breakdowns_are_exit_3_and_errors_in_junit(self):
        for settings, message in (
                (("pbs.stop_residual=1e-12", "pbs.iterations=2"),
                 r"^pose not reached: pbs is not converged in frame 0: worst tet \d+ of volume ratio"),
                (("pbs.gravity_m_s2=[0.0,-1e300,0.0]", "pbs.jiggle.k_stretch=0.9"), "not finite")):
            with self.subTest(message):
                self.write_bounds_with(*settings)
                process = self.check(3, "--junit", self.path("volume.xml"))
                error = self.message_of("error", "arm", "runs")
                self.assertRegex(error, message)
                self.assertIn(error, process.stderr)


SOURCE = pathlib.Path(program.SOURCE)
WORKFLOW = SOURCE / ".github" / "workflows" / "volume.yml"
ELSEWHERE = SOURCE / ".github" / "examples" / "volume_elsewhere.yml"
RIG = SOURCE / ".github" / "examples" / "volume_of_a_rig.yml"
SHELL = ["sh", "-e", "-c"]

EXPORT = pathlib.Path(__file__).with_name("export_frames.sh.in").read_text()


def steps(workflow=WORKFLOW):
    """The script of each step that has one, by its name: `run: COMMAND`, or `run: |` and the lines with deeper
    indentation."""
    found, name, block = {}, None, None
    for line in workflow.read_text(encoding="utf-8").splitlines():
        depth = len(line) - len(line.lstrip())
        if block is not None and depth > block:
            found[name] += line.strip() + "\n"
            continue
        block = None
        if match := re.match(r"\s*- name: (.*)", line):
            name = match[1]
        elif match := re.match(r"\s*run: (.*)", line):
            found[name] = "" if match[1] == "|" else match[1] + "\n"
            block = depth if match[1] == "|" else None
    return found


class Workflows(program.ProgramTest):
    def test_every_step_is_a_script(self):
        for workflow, names in ((WORKFLOW, ["Certificates and git", "Build", "Hold the bounds",
                                            "Measure written frames"]),
                                (ELSEWHERE, ["Certificates and git", "Packages", "Build", "Export frames",
                                             "Hold the bounds"]),
                                (RIG, ["Certificates and git", "Packages", "Build", "Hold the bound"])):
            self.assertEqual(list(steps(workflow)), names)
            for name, script in steps(workflow).items():
                self.assertTrue(script, name)
                subprocess.run(["sh", "-n", "-c", script], check=True)

    def test_the_build_names_what_there_is(self):
        presets = json.loads((SOURCE / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        for packages, build in ((steps()["Build"], steps()["Build"]),
                                *((steps(example)["Packages"], steps(example)["Build"])
                                  for example in (ELSEWHERE, RIG))):
            self.assertIn("provide_packages()",
                          (SOURCE / re.search(r"source (\S+)", packages)[1]).read_text(encoding="utf-8"))
            self.assertIn(re.search(r"--preset (\S+)", build)[1], [preset["name"] for preset in presets])
            options = re.findall(r"-D(\w+)=", build)
            self.assertTrue(options)
            for option in options:
                self.assertRegex((SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"), rf"\boption\({option}\s")

    def act(self, script, environment):
        return subprocess.run([*SHELL, script], cwd=self.folder, env=environment, capture_output=True, text=True,
                              timeout=120)

    def test_the_steps_of_pbskin_run(self):
        self.script("build/release/bin/pbskin", f'exec "{program.PBSKIN}" "$@"\n')
        environment = {**os.environ, "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": self.path("summary.md")}
        status = {name: self.act(steps()[name], environment).returncode
                  for name in ("Hold the bounds", "Measure written frames")}
        report = self.path("results", "volume.xml")
        # meshes of another CGAL, whose baselines must differ
        other_meshes = run_records.scenes_of_another_mesh(self.path("results", "check"))
        failed = run_records.failed_cases(report)
        self.assertEqual(failed, run_records.baselines_of(other_meshes, report))
        self.assertEqual(status, {"Hold the bounds": 1 if failed else 0, "Measure written frames": 0})
        self.assertEqual(run_records.failed_cases(self.path("results", "frames.xml")), set())
        self.assertIn("### pbskin:", self.read("summary.md"))

    def test_frames_within_and_beyond_the_bounds(self):
        """A limb twisted by 150 degrees, by the paper's method and by linear blend skinning (C01, C02)."""
        self.script("pbskin/build/release/bin/pbskin", f'exec "{program.PBSKIN}" "$@"\n')
        for deformer, status in (("pbs", 0), ("lbs", 1)):
            with self.subTest(deformer):
                self.script("EXPORT_FRAMES", EXPORT.format(pbskin=program.PBSKIN, deformer=deformer))
                for name in ("Export frames", "Hold the bounds"):
                    process = self.act(steps(ELSEWHERE)[name], os.environ)
                    self.assertEqual(process.returncode, status if name == "Hold the bounds" else 0,
                                     process.stdout + process.stderr)
                failed = run_records.failed_cases(self.path("results", "frames.xml"))
                self.assertEqual(bool(failed), status == 1, failed)

    def test_a_rig_within_and_beyond_the_bound(self):
        """A tube that is bent by 70 degrees, and one whose first pose is its only one."""
        self.script("pbskin/build/release/bin/pbskin", f'exec "{program.PBSKIN}" "$@"\n')
        for options, status in (({}, 1), ({"one_joint": True}, 0)):
            with self.subTest(options):
                rig_files.write("plain", self.path("MODEL.glb"), **options)
                process = self.act(steps(RIG)["Hold the bound"].replace("--max-volume-change 3",
                                                                        "--max-volume-change 0.1"), os.environ)
                self.assertEqual(process.returncode, status, process.stdout + process.stderr)
                self.assertEqual(len(run_records.failed_cases(self.path("results", "volume.xml"))), status)


if __name__ == "__main__":
    unittest.main()
