"""A checker finds nothing in the project's sources, except what is disabled where it is named, and it does find planted
errors: cppcheck (suppressions: cmake/cppcheck_suppressions.txt; one that is no longer needed is a finding too) in the
C++, shellcheck in the scripts. Only `./check --long` searches the C++."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Checker:
    def findings(self, root, paths, *options):
        """(whether the checker finds anything, its output) for these paths below root."""
        done = subprocess.run([*self.command, *options, *paths], cwd=root, capture_output=True, text=True, check=False)
        self.assertIn(done.returncode, (0, self.found), done.stderr)
        return done.returncode == self.found, done.stdout + done.stderr

    def test_finds_nothing(self):
        self.assertEqual(self.findings(SOURCE, self.sources(), *self.options), (False, ""))

    def test_finds_what_is_planted(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, self.file).write_text(self.planted, encoding="utf-8")
            found, text = self.findings(folder, [self.file])
        self.assertTrue(found)
        for words in self.expected:
            self.assertIn(words, text)


class Cppcheck(Checker, unittest.TestCase):
    command = [os.environ.get("PBS_CPPCHECK"), "--std=c++20", "--enable=warning,performance,portability,information",
               "--quiet", "--error-exitcode=3", "--template={file}:{line}: {id}: {message}", "-I", "."]
    options, found = ["--suppressions-list=cmake/cppcheck_suppressions.txt"], 3
    file, planted = "planted.cpp", """#include <vector>
int last(const std::vector<int>* values)
{
    int sum;
    if (!values) return values->back();
    return sum;
}
"""
    expected = ("planted.cpp:5: nullPointerRedundantCheck", "planted.cpp:6: uninitvar")

    def sources(self):
        return ["pbs", "reference_fem", "analysis", "experiments"]

    @unittest.skipUnless(os.environ.get("PBS_LONG"), "takes a minute")
    def test_finds_nothing(self):
        version = subprocess.run([os.environ["PBS_CPPCHECK"], "--version"], capture_output=True, text=True,
                                 check=True).stdout.strip()
        if version != "Cppcheck 2.10":
            self.skipTest(f"{version} has other false findings than 2.10, for which the suppressions are")
        super().test_finds_nothing()


class Shellcheck(Checker, unittest.TestCase):
    command, options, found = [os.environ.get("PBS_SHELLCHECK"), "-x", "--format=gcc"], [], 1
    file, planted = "planted.sh", "#!/bin/bash\nfor file in $(ls *.csv); do rm $file; done\n"
    expected = ("planted.sh:2:13: error: Iterating over ls output", "SC2086")

    def is_script(self, path):
        if path.suffix == ".sh":
            return True
        with open(path, "rb") as file:
            return re.match(rb"#!.*\b(ba)?sh\b", file.readline(80)) is not None

    def sources(self):
        inside = [path for folder in (".ci", "cmake", "experiments", "paper_figures", "tests")
                  for path in (SOURCE / folder).rglob("*")
                  if "node_modules" not in path.parts]
        scripts = {str(path.relative_to(SOURCE)) for path in [*SOURCE.iterdir(), *inside] if path.is_file()
                   and self.is_script(path)}
        self.assertLessEqual({"check", "reproduce", "cmake/setup.sh"}, scripts)
        return sorted(scripts)


if __name__ == "__main__":
    unittest.main()
