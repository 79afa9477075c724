"""Reference: the definition. A reader finds either the complete old file or the complete new one, and an error leaves nothing
half-written."""
import pathlib
import sys
import tempfile
import unittest

root = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(root / "experiments/sweeps"))

from atomic_text import atomic_text, write_atomically  # noqa: E402


class AtomicText(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_the_file_of_before_until_the_end(self):
        path = self.folder / "new/table.csv"
        write_atomically(path, "before\r\n")
        with atomic_text(path) as file:
            file.write("after\n")
            file.flush()
            self.assertEqual(path.read_bytes(), b"before\r\n")
        self.assertEqual(path.read_bytes(), b"after\n")
        self.assertEqual(path.stat().st_mode & 0o777, 0o644)
        self.assertEqual([other.name for other in path.parent.iterdir()], ["table.csv"])

    def test_an_error_leaves_the_file_of_before(self):
        path = self.folder / "table.csv"
        write_atomically(path, "before\n")
        with self.assertRaises(KeyboardInterrupt), atomic_text(path) as file:
            file.write("half")
            raise KeyboardInterrupt
        self.assertEqual([other.name for other in self.folder.iterdir()], ["table.csv"])
        self.assertEqual(path.read_text(), "before\n")

    def test_a_folder_in_the_way(self):
        (self.folder / "table.csv/inner").mkdir(parents=True)
        with self.assertRaises(OSError):
            write_atomically(self.folder / "table.csv", "text")
        self.assertEqual([other.name for other in self.folder.iterdir()], ["table.csv"])


if __name__ == "__main__":
    unittest.main()
