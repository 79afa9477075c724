"""The steps of .github/workflows/volume.yml do what they say: those of pbskin are run in a folder of their own, those that build name
functions, presets and targets that there are. Truth: the file itself."""
import json
import os
import pathlib
import re
import subprocess
import unittest

import check_records
import program

SOURCE = pathlib.Path(program.SOURCE)
WORKFLOW = SOURCE / ".github" / "workflows" / "volume.yml"


def steps():
    """The script of each step that has one, by its name: `run: COMMAND`, or `run: |` and the lines that stand deeper."""
    found, name, block = {}, None, None
    for line in WORKFLOW.read_text(encoding="utf-8").splitlines():
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


class VolumeWorkflow(program.ProgramTest):
    def test_every_step_is_a_script(self):
        self.assertEqual(list(steps()), ["Certificates and git", "Build", "Hold the bounds", "Measure written frames"])
        for name, script in steps().items():
            subprocess.run(["bash", "-n", "-c", script], check=True)
            self.assertTrue(script, name)

    def test_the_build_names_what_there_is(self):
        script = steps()["Build"]
        self.assertIn("provide_packages()", (SOURCE / re.search(r"source (\S+)", script)[1]).read_text(encoding="utf-8"))
        presets = json.loads((SOURCE / "CMakePresets.json").read_text(encoding="utf-8"))["configurePresets"]
        self.assertIn(re.search(r"--preset (\S+)", script)[1], [preset["name"] for preset in presets])

    def test_the_steps_of_pbskin_run(self):
        os.makedirs(self.path("build", "release", "bin"))
        with open(self.path("build", "release", "bin", "pbskin"), "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\nexec "%s" "$@"\n' % program.PBSKIN)
        os.chmod(self.path("build", "release", "bin", "pbskin"), 0o755)
        environment = {**os.environ, "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": self.path("summary.md")}
        status = {}
        for name in ("Hold the bounds", "Measure written frames"):
            process = subprocess.run(["bash", "-e", "-c", steps()[name]], cwd=self.folder, env=environment, capture_output=True, text=True,
                                     timeout=120)
            status[name] = process.returncode
        report = self.path("results", "volume.xml")
        other_meshes = check_records.scenes_of_another_mesh(self.path("results", "check"))  # another CGAL's: their baselines must tell
        failed = check_records.failed(report)
        self.assertEqual(failed, check_records.baselines_of(other_meshes, report))
        self.assertEqual(status, {"Hold the bounds": 1 if failed else 0, "Measure written frames": 0})
        self.assertEqual(check_records.failed(self.path("results", "frames.xml")), set())
        self.assertIn("### pbskin:", self.read("summary.md"))


if __name__ == "__main__":
    unittest.main()
