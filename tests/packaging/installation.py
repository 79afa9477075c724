"""Installs components of the build under test into a separate folder, and moves them before they are used."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["PBS_BUILD"])
SOURCE = pathlib.Path(os.environ["PBS_SOURCE"])
CMAKE = os.environ["PBS_CMAKE"]
scratch = tempfile.TemporaryDirectory()
folder = pathlib.Path(scratch.name)
unittest.addModuleCleanup(scratch.cleanup)


def run(*words, timeout=1800, check=False, **options):
    """Like subprocess.run, with text output; at a timeout, the compilers that the command started end with it."""
    words = [str(word) for word in words]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                          **options) as process:
        try:
            out, err = process.communicate(timeout=timeout)
        except BaseException:
            os.killpg(process.pid, signal.SIGKILL)
            raise
    ended = subprocess.CompletedProcess(words, process.returncode, out, err)
    if check:
        ended.check_returncode()
    return ended


def install(component, build=BUILD):
    """The prefix, which differs from the one at installation."""
    installed = run(CMAKE, "--install", build, "--component", component, "--prefix", folder / "installed")
    if installed.returncode != 0:
        raise RuntimeError(installed.stdout + installed.stderr)
    return (folder / "installed").rename(folder / f"moved_{component}_{build.name}")


def configured(source, build, *definitions):
    """The finished configuration of another project in a build folder."""
    return run(CMAKE, "-S", source, "-B", folder / build, "-G", "Ninja", *definitions)


class BuildTest(unittest.TestCase):
    def succeeds(self, ended):
        self.assertEqual(ended.returncode, 0, ended.stdout + ended.stderr)
        return ended

    def refused(self, ended, words):
        self.assertNotEqual(ended.returncode, 0)
        self.assertIn(words, " ".join((ended.stdout + ended.stderr).split()))

    def build(self, configuration, build, *options):
        self.succeeds(configuration)
        self.succeeds(run(CMAKE, "--build", folder / build, *options))


def files_naming(prefix, path):
    """Installed files that contain that path, without links. The same letters within a longer path or an address do not
    count."""
    begins = rb"(?:(?<![\w./)}@*-])|(?<=-[IL])|(?<=file://))"
    letters = os.fsencode(path)
    named = re.compile(begins + re.escape(letters) + rb"(?![\w.-])")
    contents = ((file, file.read_bytes()) for file in sorted(prefix.rglob("*")) if file.is_file()
                and not file.is_symlink())
    # The search for the letters alone takes a fiftieth of the time.
    return [str(file.relative_to(prefix)) for file, content in contents if letters in content and named.search(content)]
