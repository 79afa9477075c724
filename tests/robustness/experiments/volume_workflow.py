"""The steps of .github/workflows/volume.yml, and of the example for another repository, work as described: those of pbskin are run in a
folder of their own by the shell of a container's job, and those that build name functions, presets and targets that exist. Reference: the
files themselves."""
import json
import os
import pathlib
import re
import subprocess
import unittest

import program
import run_records

SOURCE = pathlib.Path(program.SOURCE)
WORKFLOW = SOURCE / ".github" / "workflows" / "volume.yml"
ELSEWHERE = SOURCE / ".github" / "examples" / "volume_elsewhere.yml"
SHELL = ["sh", "-e", "-c"]

EXPORT = pathlib.Path(__file__).with_name("export_frames.sh.in").read_text()


def steps(workflow=WORKFLOW):
    """The script of each step that has one, by its name: `run: COMMAND`, or `run: |` and the lines with deeper indentation."""
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
        for workflow, names in ((WORKFLOW, ["Certificates and git", "Build", "Hold the bounds", "Measure written frames"]),
                                (ELSEWHERE, ["Certificates and git", "Packages", "Build", "Export frames", "Hold the bounds"])):
            self.assertEqual(list(steps(workflow)), names)
            for name, script in steps(workflow).items():
                self.assertTrue(script, name)
                subprocess.run(["sh", "-n", "-c", script], check=True)

    def test_the_build_names_what_there_is(self):
        presets = json.loads((SOURCE / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        for packages, build in ((steps()["Build"], steps()["Build"]), (steps(ELSEWHERE)["Packages"], steps(ELSEWHERE)["Build"])):
            self.assertIn("provide_packages()", (SOURCE / re.search(r"source (\S+)", packages)[1]).read_text(encoding="utf-8"))
            self.assertIn(re.search(r"--preset (\S+)", build)[1], [preset["name"] for preset in presets])
            options = re.findall(r"-D(\w+)=", build)
            self.assertTrue(options)
            for option in options:
                self.assertIn(f"option({option} ", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))

    def act(self, script, environment):
        return subprocess.run([*SHELL, script], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=120)

    def test_the_steps_of_pbskin_run(self):
        self.script("build/release/bin/pbskin", f'exec "{program.PBSKIN}" "$@"\n')
        environment = {**os.environ, "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": self.path("summary.md")}
        status = {name: self.act(steps()[name], environment).returncode for name in ("Hold the bounds", "Measure written frames")}
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
                    self.assertEqual(process.returncode, status if name == "Hold the bounds" else 0, process.stdout + process.stderr)
                failed = run_records.failed_cases(self.path("results", "frames.xml"))
                self.assertEqual(bool(failed), status == 1, failed)


if __name__ == "__main__":
    unittest.main()
