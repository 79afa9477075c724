"""cppcheck finds nothing in the project's code, except what cmake/cppcheck_suppressions.txt lists, and it does find planted errors."""
import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ["pbs", "reference_fem", "analysis", "experiments"]
PLANTED = """#include <vector>
int last(const std::vector<int>* values)
{
    int sum;
    if (!values) return values->back();
    return sum;
}
"""


def findings(root, paths, *options):
    """(exit status, output of cppcheck) for these paths below root; the status is 3 if it finds anything."""
    command = [os.environ["PBS_CPPCHECK"], "--std=c++20", "--enable=warning,performance,portability,information", "--quiet",
               "--error-exitcode=3", "--template={file}:{line}: {id}: {message}", "-I", ".", *options, *paths]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class Cppcheck(unittest.TestCase):
    def test_finds_nothing(self):
        """A suppression that is no longer needed is a finding too."""
        self.assertEqual(findings(SOURCE, FOLDERS, "--suppressions-list=cmake/cppcheck_suppressions.txt"), (0, ""))

    def test_finds_what_is_planted(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "planted.cpp").write_text(PLANTED, encoding="utf-8")
            status, text = findings(folder, ["planted.cpp"])
        self.assertEqual(status, 3)
        self.assertIn("planted.cpp:5: nullPointerRedundantCheck", text)
        self.assertIn("planted.cpp:6: uninitvar", text)


if __name__ == "__main__":
    unittest.main()
