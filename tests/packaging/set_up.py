"""Tests what a user reads if the machine is not as expected: versions of libraries, a build that fails, packages that a
system does not have, npm out of reach. Reference: the sentence that the set-up scripts promise, and the versions in
cmake/packages.txt."""
import os
import pathlib
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["PBS_SOURCE"])
CMAKE = os.environ["PBS_CMAKE"]


def versions(name):
    """The oldest and the newest version tried of the library that CMake knows by this name."""
    row, = [line.split() for line in (SOURCE / "cmake" / "packages.txt").read_text().splitlines()
            if f"[{name}]" in line]
    return ".".join(row[1].split(".")[:2]), ".".join(row[2].split(".")[:2])


class ScratchCase(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)


class KnownVersions(ScratchCase):
    """A project that finds CGAL, of which a made-up version is installed."""

    def configured(self, version, name="CGAL"):
        (self.folder / "cmake").mkdir(exist_ok=True)
        (self.folder / "cmake" / "packages.txt").write_text((SOURCE / "cmake" / "packages.txt").read_text())
        (self.folder / "CGALConfig.cmake").write_text("set(CGAL_FOUND TRUE)\n")
        (self.folder / "CGALConfigVersion.cmake").write_text(f"set(PACKAGE_VERSION {version})\n"
                                                             "set(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
        (self.folder / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES NONE)\n"
                                                    f"include({SOURCE}/cmake/known_versions.cmake)\n"
                                                    f"find_known({name})\n")
        log = self.folder / "configure.txt"
        with log.open("w") as file:
            status = subprocess.run([CMAKE, "-S", self.folder, "-B", self.folder / "build",
                                     f"-DCGAL_DIR={self.folder}"], stdout=file,
                                    stderr=subprocess.STDOUT, check=False).returncode
        return status, log.read_text(), first_error(log)

    def test_all_between_the_oldest_and_the_newest_are_silent(self):
        for version in versions("CGAL"):
            status, said, _ = self.configured(version)
            self.assertEqual(status, 0, said)
            self.assertNotIn("CGAL", said)

    def test_an_older_one_ends_the_configuration_in_one_sentence(self):
        status, _, error = self.configured("4.14.3")
        self.assertEqual(status, 1)
        self.assertEqual(error, f"CGAL 4.14 is older than {versions('CGAL')[0]}, the oldest version that was tried; "
                                "Debian 12 "
                                "and later releases have it (libcgal-dev)")

    def test_a_newer_one_is_named(self):
        status, said, _ = self.configured("99.1")
        self.assertEqual(status, 0)
        self.assertIn(f"\nCGAL 99.1 is newer than {versions('CGAL')[1]}, the newest version that was tried "
                      "(Debian 13)\n", f"\n{said}")

    def test_one_that_states_its_version_in_a_header_is_judged_alike(self):
        oldest, newest = versions("gmsh")
        for version, status, said in ((oldest, 0, ""), ("3.0", 1, f"gmsh 3.0 is older than {oldest}"),
                                      ("99.1", 0, f"gmsh 99.1 is newer than {newest}")):
            major, minor = version.split(".")
            header = self.folder / "gmsh.h"
            header.write_text(f"#define G_VERSION \"{version}\"\n#define G_MAJOR {major}\n#define G_MINOR   "
                              f"{minor}  \n")
            done, log, _ = self.configured("5.5.1", f"CGAL)\nrequire_known_header(gmsh {header} G_MAJOR G_MINOR")
            self.assertEqual(done, status, log)
            self.assertEqual("gmsh" in log, bool(said), log)
            self.assertIn(said, " ".join(log.split()))

    def test_a_missing_one_is_named_with_its_package(self):
        (self.folder / "CGALConfig.cmake").write_text("")
        status, _, error = self.configured("5.5.1", "deal.II HINTS /none NO_DEFAULT_PATH")
        self.assertEqual((status, error),
                         (1, "deal.II is not installed; on Debian and Ubuntu: apt-get install libdeal.ii-dev"))


def first_error(log):
    return shell(f"first_error {log}").stdout.strip()


def shell(script, **environment):
    """In a shell that has the functions of setup.sh."""
    return subprocess.run(["bash", "-c", f"source cmake/setup.sh; {script}"], cwd=SOURCE, env=os.environ | environment,
                          check=False, capture_output=True, text=True)


class FirstError(ScratchCase):
    def test_is_found_for_each_program(self):
        for printed, error in (
                ("[1/3] x\nFAILED: x.o\na.cpp:3:1: fatal error: b.h: No\n    3 | #include\n",
                 "a.cpp:3:1: fatal error: b.h: No"),
                ("CMake Error at a.cmake:2 (message):\n  One sentence\n  on two lines\n\nCall Stack:\n  b\n",
                 "One sentence on two lines"),
                ("CMake Error: CMake was unable to find a build program\n-- Configuring incomplete\n",
                 "CMake was unable to find a build program"),
                ("a.cpp:1:2: warning: this is an error: no\na.cpp:2:1: error: yes\n", "a.cpp:2:1: error: yes"),
                ("/usr/bin/ld: cannot find -lfoo\ncollect2: error: ld returned 1\n", "/usr/bin/ld: cannot find -lfoo"),
                ("CMake Warning at a:\n  x\n\nninja: error: loading 'build.ninja'\n",
                 "ninja: error: loading 'build.ninja'"),
                ("x.o: in function `f':\nundefined reference to `g()'\n", "undefined reference to `g()'"),
                ("Hit: 1\nE: Unable to locate package x\n", "E: Unable to locate package x"),
                ("npm ERR! code E\nnpm ERR! errno E\nnpm ERR! request to a failed\n", "npm ERR! request to a failed"),
                ("npm error code E\nnpm error network\n", "npm error network"),
                ("one\nthe last\n\n", "the last"), ("", "")):
            log = self.folder / "log"
            log.write_text(printed)
            self.assertEqual(first_error(log), error)

    def test_is_the_cause_of_what_failed(self):
        done = shell(f"logged {self.folder}/log bash -c 'echo a:1:2: error: b; exit 3' || echo \"$?: $cause\"")
        self.assertEqual(done.stdout, f"3: a:1:2: error: b (all of it: {self.folder}/log)\n")


class ProgramsCase(ScratchCase):
    def program(self, name, script):
        (self.folder / name).write_text(f"#!/bin/sh\n{script}\n")
        (self.folder / name).chmod(0o755)

    def with_programs(self, script):
        return shell(script, PATH=f"{self.folder}:{os.environ['PATH']}")


class Warnings(ProgramsCase):
    def test_files_with_one_are_newer_than_their_objects_after_the_build(self):
        for name in ("warned.cpp", "silent.cpp"):
            (self.folder / name).touch()
            os.utime(self.folder / name, (0, 0))
        self.program("cmake", f"echo '{self.folder}/warned.cpp:1:2: warning: a'; echo '/usr/include/other.hpp:3: "
                              "warning: b'")
        done = self.with_programs(f"cd {self.folder}; output={self.folder}; jobs=1; set -euo pipefail; built")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater((self.folder / "warned.cpp").stat().st_mtime, 0)
        self.assertEqual((self.folder / "silent.cpp").stat().st_mtime, 0)


class Packages(ProgramsCase):
    def test_one_that_the_system_does_not_have_is_named_and_left_out(self):
        self.program("apt-cache", 'test "$2" != mandoc')
        self.program("apt-get", f'echo "$@" >> {self.folder}/asked')
        self.program("sudo", 'exec "$@"')
        done = self.with_programs(f"output={self.folder}/out; install_packages valgrind mandoc gcovr < /dev/null")
        self.assertIn("mandoc: ", done.stdout)
        self.assertTrue((self.folder / "asked").read_text().endswith(" valgrind gcovr\n"), done.stderr)

    def test_one_that_is_required_and_unknown_to_apt_ends_the_installation(self):
        self.program("apt-cache", 'test "$2" != libcgal-dev')
        self.program("apt-get", f'echo "$@" >> {self.folder}/asked')
        self.program("sudo", 'exec "$@"')
        done = self.with_programs(f"output={self.folder}/out; install_packages libcgal-dev valgrind < /dev/null")
        self.assertEqual(done.returncode, 2)
        self.assertIn("libcgal-dev: apt does not know this package, which is required", done.stderr)
        self.assertNotIn("install", (self.folder / "asked").read_text())

    def test_npm_that_cannot_fetch_is_tried_again_the_next_time(self):
        viewer = self.folder / "paper_figures" / "viewer"
        viewer.mkdir(parents=True)
        (viewer / "package-lock.json").write_text("{}")
        self.program("npm", 'echo "npm ERR! $1 failed" >&2; mkdir -p node_modules; exit 1')
        for _ in range(2):
            done = self.with_programs(f"cd {self.folder}; logged log build_viewer || echo \"$cause\"")
            self.assertEqual(done.stdout, "npm ERR! ci failed (all of it: log)\n")


if __name__ == "__main__":
    unittest.main()
