"""Runs the program under test as a user does."""
import csv
import io
import json
import os
import subprocess
import tempfile
import unittest

PBSKIN = os.environ["PBSKIN"]
SOURCE = os.environ["PBS_SOURCE"]


def run(*arguments, **options):
    """The finished process of `pbskin ARGUMENTS`, its output as text."""
    return subprocess.run([PBSKIN, *map(str, arguments)], capture_output=True, text=True, timeout=800, **options)


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = self.temporary.name
        self.addCleanup(self.temporary.cleanup)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def script(self, name, text, mode=0o755):
        """A shell script below the folder."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        os.chmod(self.write(name, "#!/bin/sh\n" + text), mode)

    def read(self, *parts):
        with open(self.path(*parts), encoding="utf-8") as file:
            return file.read()

    def json(self, *parts):
        return json.loads(self.read(*parts))

    def rows(self, *parts):
        """The rows of a table."""
        return list(csv.DictReader(io.StringIO(self.read(*parts))))

    def ends(self, status, *arguments, says="", **options):
        """The process of `pbskin ARGUMENTS`, which ends with this status and message."""
        process = run(*arguments, **options)
        self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        self.assertIn(says, process.stderr)
        return process

    def succeeds(self, *arguments, **options):
        return self.ends(0, *arguments, **options)

    def refuses(self, message, *arguments, **options):
        return self.ends(2, *arguments, says=message, **options)
