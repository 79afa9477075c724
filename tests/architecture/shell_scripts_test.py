"""shellcheck finds nothing in the shell scripts, except where they disable a rule themselves, and it does find planted errors."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = [".ci", "cmake", "experiments", "paper_figures", "tests"]
PLANTED = '#!/bin/bash\nfor file in $(ls *.csv); do rm $file; done\n'


def is_script(path):
    if path.suffix == ".sh":
        return True
    with open(path, "rb") as file:
        return re.match(rb"#!.*\b(ba)?sh\b", file.readline(80)) is not None


def scripts():
    inside = [path for folder in FOLDERS for path in (SOURCE / folder).rglob("*") if "node_modules" not in path.parts]
    return sorted(str(path.relative_to(SOURCE)) for path in [*SOURCE.iterdir(), *inside] if path.is_file() and is_script(path))


def findings(root, paths):
    """(exit status, output of shellcheck) for these paths below root; the status is 1 if it finds anything."""
    command = [os.environ["PBS_SHELLCHECK"], "-x", "--format=gcc", *paths]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Shellcheck(unittest.TestCase):
    def test_finds_nothing(self):
        self.assertLessEqual({"check", "reproduce", "cmake/setup.sh"}, set(scripts()))
        self.assertEqual(findings(SOURCE, scripts()), (0, ""))

    def test_finds_what_is_planted(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "planted.sh").write_text(PLANTED, encoding="utf-8")
            status, text = findings(folder, ["planted.sh"])
        self.assertEqual(status, 1)
        self.assertIn("planted.sh:2:13: error: Iterating over ls output", text)
        self.assertIn("SC2086", text)


if __name__ == "__main__":
    unittest.main()
