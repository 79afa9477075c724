"""Runs the program under test as a user does."""
import csv
import glob
import io
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

PBSKIN = os.environ["PBSKIN"]
SOURCE = os.environ["PBS_SOURCE"]
MODULES = glob.glob(os.path.join(os.path.dirname(PBSKIN), "..", "lib", "**", "libpbskin_*.so"), recursive=True)
HAS_FEM = any(file.endswith("_fem.so") for file in MODULES)


MOST_BYTES = 2 << 30  # of memory, for one model


def processor_s():
    """Of all processes that have ended so far [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def most_memory_bytes():
    """The peak of the process that took most."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024


def run(*arguments, **options):
    """The finished process of `pbskin ARGUMENTS`, its output as text."""
    return subprocess.run([PBSKIN, *map(str, arguments)], capture_output=True, text=True, timeout=800, **options)


def statuses():
    """Process -> (state, parent, session) of all processes of this machine, from /proc."""
    found = {}
    for entry in os.listdir("/proc"):
        try:
            fields = (pathlib.Path("/proc", entry, "stat").read_text().rsplit(")", 1)[1].split() if entry.isdigit()
                      else None)
        except OSError:  # the process has ended meanwhile
            continue
        if fields:
            found[int(entry)] = (fields[0], int(fields[1]), int(fields[3]))
    return found


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

    def explains_columns(self, *tables, labels):
        """`pbskin explain` knows the columns of these tables that are no labels."""
        columns = {name for table in tables for name in self.rows(table)[0]}
        self.assertLessEqual(set(labels), columns)
        for name in sorted(columns - set(labels)):
            with self.subTest(name):
                self.assertIn(f"{name} (metric)", self.succeeds("explain", name).stdout)

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
