"""A command that exceeds its time limit ends with all processes that it started, such as cmake with ninja and the compilers. Reference: the
processes that exist."""
import pathlib
import subprocess
import time
import unittest

from installation import folder, run


def state(stat):
    try:
        return stat.read_text().rsplit(")", 1)[1].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return "gone"


class Timeouts(unittest.TestCase):
    def test_what_it_started_ends_with_it(self):
        begin = time.monotonic()
        with self.assertRaises(subprocess.TimeoutExpired):
            run("sh", "-c", "sleep 60 & echo $! >started; wait", cwd=folder, timeout=1)
        self.assertLess(time.monotonic() - begin, 30)
        stat = pathlib.Path("/proc", (folder / "started").read_text().strip(), "stat")
        while state(stat) not in ("gone", "Z", "X"):  # a busy machine delivers a signal late
            self.assertLess(time.monotonic() - begin, 30)
            time.sleep(0.05)

    def test_what_it_said_and_how_it_ended(self):
        ended = run("sh", "-c", "echo out; echo err >&2; exit 3")
        self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (3, "out\n", "err\n"))
        with self.assertRaises(subprocess.CalledProcessError):
            run("false", check=True)


if __name__ == "__main__":
    unittest.main()
