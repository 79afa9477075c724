"""Figures are complete or do not exist. Reference: the contents of the folder after each way in which drawing can end."""
import os
import pathlib
import resource
import signal
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "paper_figures"))

from results_case import ResultsTest
from records import whole_file


class WholeFile(ResultsTest):
    def setUp(self):
        super().setUp()
        self.file = self.results / "volume.png"
        self.file.write_text("old")

    def names(self):
        return sorted(path.name for path in self.results.iterdir())

    def drawn_elsewhere(self, lines):
        """How a separate process that draws has ended."""
        text = f"import os, pathlib, signal, whole_file\nwith whole_file.beside(pathlib.Path({str(self.file)!r})) as path:\n{lines}"
        paths = {**os.environ, "PYTHONPATH": str(pathlib.Path(whole_file.__file__).parent)}
        return subprocess.run([sys.executable, "-B", "-c", text], env=paths, capture_output=True).returncode

    def test_takes_its_place_when_it_is_whole(self):
        with whole_file.beside(self.file) as path:
            self.assertEqual(path.suffix, ".png")
            path.write_text("new")
            self.assertEqual(self.file.read_text(), "old")
        self.assertEqual((self.file.read_text(), self.names()), ("new", ["volume.png"]))

    def test_a_failure_leaves_the_old_one(self):
        with self.assertRaises(KeyError), whole_file.beside(self.file) as path:
            path.write_text("half")
            raise KeyError
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_a_kill_leaves_the_old_one_and_the_next_drawing_removes_the_half(self):
        killed = self.drawn_elsewhere(" path.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)")
        self.assertEqual(killed, -signal.SIGKILL)
        self.assertEqual(self.file.read_text(), "old")
        self.assertEqual(len(self.names()), 2)
        with whole_file.beside(self.file) as path:
            path.write_text("new")
        self.assertEqual((self.file.read_text(), self.names()), ("new", ["volume.png"]))

    def test_a_full_disk_names_the_file_and_the_reason(self):
        usual = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, usual[1]))  # Python ignores SIGXFSZ, so write() fails
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, usual)
        with self.assertRaisesRegex(whole_file.CannotBeWritten,
                                    "volume.png: cannot be written: File too large"), whole_file.beside(self.file) as path:
            path.write_bytes(bytes(5000))
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_a_reason_that_is_not_the_systems_is_told_in_its_own_words(self):
        expected = "volume.png: cannot be written: encoder error -2 when writing image file"  # the words of the image library
        with self.assertRaisesRegex(whole_file.CannotBeWritten, expected), whole_file.beside(self.file):
            raise OSError("encoder error -2 when writing image file")

    def test_what_the_block_cannot_read_is_not_called_unwritable(self):
        with self.assertRaises(FileNotFoundError), whole_file.beside(self.file):
            (self.results / "elsewhere" / "records.csv").read_text()
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_the_folder_is_made_or_why_it_cannot_be_is_told(self):
        with whole_file.beside(self.results / "figures" / "new" / "a.png") as path:
            path.write_text("new")
        self.assertEqual((self.results / "figures" / "new" / "a.png").read_text(), "new")
        for below in ("volume.png/a.png", "volume.png/figures/a.png"):  # a file where the folder would be
            with self.subTest(below), self.assertRaisesRegex(whole_file.CannotBeWritten, "a.png: cannot be written: "):
                with whole_file.beside(self.results / below) as path:
                    path.write_text("new")


if __name__ == "__main__":
    unittest.main()
