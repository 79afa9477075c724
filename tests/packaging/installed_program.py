"""The installed program runs in any folder, after a move, and without the source tree: everything it needs is installed
with it.

Reference: the folders in the file system, and the fields of the records.
"""
import json
import shutil
import unittest

import installation
from installation import SOURCE, folder, run


def setUpModule():
    global prefix
    prefix = installation.install("program")


class InstalledProgram(installation.BuildTest):
    def pbskin(self, *arguments, program="pbskin"):
        elsewhere = folder / "elsewhere"
        elsewhere.mkdir(exist_ok=True)
        environment = {"PATH": "/usr/bin:/bin", "HOME": str(elsewhere)}
        return self.succeeds(run(prefix / "bin" / program, *arguments, cwd=elsewhere, env=environment))

    # A file that names the source tree would need it.
    def test_nothing_names_the_source_tree(self):
        self.assertEqual(installation.files_naming(prefix, SOURCE), [])

    def test_list(self):
        self.assertIn("limb_twist", self.pbskin("list", "scenes").stdout)

    def test_a_scene_with_its_modules(self):
        self.pbskin("run", "limb_twist", "-o", "twist", "--quiet", "--set", "motion.frames=2", "--set",
                    "motion.angle_deg=20", "--set", "character.vertices=500")
        record = json.loads((folder / "elsewhere/twist/run.json").read_text())
        self.assertIn("fem", json.dumps(record["scene"]))

    def test_audit_and_its_report(self):
        self.pbskin("reproduce", "audit", "-o", "audit", "--quiet")
        self.pbskin("report", "audit", "--quiet")
        page = (folder / "elsewhere/audit/report.html").read_text(encoding="utf-8")
        self.assertIn("C13", page)

    def test_sweeps_by_the_program_beside(self):
        example = prefix / "share/pbskin/sweeps/examples/limb_bend.toml"
        self.assertRegex(self.pbskin("check", example, program="pbskin-sweep").stdout, r"(?m)^\d+ runs$")
        if shutil.which("snakemake", path="/usr/bin:/bin"):
            self.pbskin("run", example, "-o", "sweep", "-j", "2", program="pbskin-sweep")
            self.assertTrue((folder / "elsewhere/sweep/sweep.csv").is_file())

    def test_what_it_reads_is_there(self):
        for name in ("share/pbskin/paper_figures/make_all.py", "share/pbskin/CITATION.cff", "share/pbskin/claims.toml",
                     "share/pbskin/scenes/limb_twist.toml", "share/man/man1/pbskin.1", "share/man/man5/pbskin-scene.5",
                     "share/bash-completion/completions/pbskin", "share/zsh/site-functions/_pbskin",
                     "lib/pbskin/libpbskin_native_plain.so", "bin/pbskin-sweep", "share/pbskin/sweeps/Snakefile",
                     "share/pbskin/sweeps/slurm/config.yaml", "share/pbskin/sweeps/examples/limb_bend.toml"):
            self.assertTrue((prefix / name).is_file(), name)
        left_behind = [str(file) for file in prefix.rglob("*") if file.name in ("node_modules", "__pycache__", "src",
                                                                                "package.json")]
        self.assertEqual(left_behind, [])


if __name__ == "__main__":
    unittest.main()
