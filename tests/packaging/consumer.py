"""Another project finds the installed method, builds with it and bends a bar; a component that is not installed is
named.

Reference: a bar of two halves that fold over each other by 90 degrees loses volume under linear blend skinning (Sec. 4
of the paper), and Eq. 11 recovers most of it. The consumer's own cache shows which packages were searched for.
"""
import json
import os
import platform
import re
import shutil
import unittest

import installation
from installation import BUILD, CMAKE, SOURCE, folder, run

project = SOURCE / "tests/packaging/method_consumer"
# The flags of the build under test.
own_flags = re.search(r"^CMAKE_CXX_FLAGS:STRING=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.MULTILINE)[1]


def setUpModule():
    global prefix
    prefix = installation.install("method")


def configure(source, build, flags="", installed=None):
    return installation.configured(source, build, f"-DCMAKE_PREFIX_PATH={installed or prefix}",
                                   f"-DCMAKE_CXX_FLAGS={own_flags} {flags}")


def looked_for(build):
    """The packages that the cache of a build contains."""
    return set(re.findall(r"^([\w.]+)_DIR:PATH=", (folder / build / "CMakeCache.txt").read_text(), re.MULTILINE))


def asking_for(name, components, version=""):
    """A project that only requests these components."""
    source = folder / name
    source.mkdir()
    (source / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(asks LANGUAGES CXX)\n"
                                           f"find_package(pbs {version} {components})\n"
                                           "message(STATUS \"found ${pbs_FOUND}\")\n")
    return configure(source, name + "_build")


class MethodTest(installation.BuildTest):
    def expect_bent_bar(self, build, installed=None):
        if not (folder / build / "bent_bar").exists():
            self.build(configure(project, build, installed=installed), build)
        told = self.succeeds(run(folder / build / "bent_bar"))
        match = re.fullmatch(r"tets 1920, lbs (-[0-9.]+) %, pbs (-?[0-9.]+) %\n", told.stdout)
        self.assertTrue(match, told.stdout)
        lbs, pbs = map(float, match.groups())
        self.assertLess(lbs, -1)
        self.assertLess(abs(pbs), abs(lbs) / 2)
        return told.stdout


def conditions(build):
    """The folders of headers and the definitions with which a build compiles each source of the method, except that of
    threads."""
    commands = json.loads((build / "compile_commands.json").read_text())
    return {command["file"]: re.findall(r" -(?:I|isystem|D(?!PBS_WITH_THREADS|NDEBUG)) ?(\S+)", command["command"])
            for command in commands
            if re.search(r" -o \S*/pbs_(?:method|kernels)\.dir/", command["command"])
            and "cmake_pch" not in command["file"]}


class WithoutThreads(MethodTest):
    def test_eigen_is_all_that_the_method_needs(self):
        """Built and run, the method searches for no other package, and the number of threads does not change its
        result."""
        off = [f"-DPBS_WITH_{part}=OFF" for part in re.findall(r"option\(PBS_WITH_(\w+)",
                                                               (SOURCE / "CMakeLists.txt").read_text())]
        self.assertIn("-DPBS_WITH_THREADS=OFF", off)
        # One source is compiled: no precompiled header pays.
        off += [] if os.environ.get("PBS_LONG") else ["-DPBS_UNITY_BUILD=OFF"]
        off += [f"-DCMAKE_CXX_FLAGS={own_flags}", "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG"]  # -O0: the shortest time
        self.succeeds(installation.configured(SOURCE, "alone", *off))
        self.assertEqual(looked_for("alone"), {"Eigen3"})
        self.build_alone()
        alone = self.expect_bent_bar("consumer_alone", installation.install("method", folder / "alone"))
        self.assertEqual(looked_for("consumer_alone"), {"pbs", "Eigen3"})
        self.assertEqual(alone, self.expect_bent_bar("consumer"))

    def build_alone(self):
        """`./check --long` builds every source. Otherwise those that depend on threads are built; the others are
        compiled with the same headers and definitions in the build under test, which has their objects."""
        if os.environ.get("PBS_LONG"):
            self.succeeds(run(CMAKE, "--build", folder / "alone", "--target", "pbs_method"))
            return
        self.assertEqual(conditions(folder / "alone"), conditions(BUILD))
        dependent = {file for file in (SOURCE / "pbs").rglob("*.[ch]pp")
                     if re.search("tbb|PBS_WITH_THREADS", file.read_text())}
        self.assertEqual({file.suffix for file in dependent}, {".cpp"}, "every source depends on such a header")
        objects = [f"pbs/CMakeFiles/pbs_method.dir/{file.relative_to(SOURCE / 'pbs')}.o" for file in dependent]
        self.succeeds(run(CMAKE, "--build", folder / "alone", "--target", *objects))
        shutil.copy(BUILD / "pbs/libpbs_method.a", folder / "alone/pbs")
        self.succeeds(run("ar", "r", "pbs/libpbs_method.a", *objects, cwd=folder / "alone"))


class Consumer(MethodTest):
    def test_method_in_a_project_of_its_own(self):
        self.expect_bent_bar("consumer")
        self.assertLessEqual(looked_for("consumer"), {"pbs", "Eigen3", "TBB"},
                             "the method asks for Eigen, and oneTBB with threads")

    # An array that is allocated in one part and freed in the other would crash. EIGEN_MAX_ALIGN_BYTES limits only
    # members of fixed size.
    @unittest.skipUnless(platform.machine() == "x86_64", "the registers of x86-64")
    def test_wider_registers_are_refused(self):
        for build, flags in (("wider", "-mavx"), ("bounded", "-mavx -DEIGEN_MAX_ALIGN_BYTES=16")):
            with self.subTest(flags):
                self.succeeds(configure(project, build, flags + " -Wfatal-errors"))
                self.refused(run(CMAKE, "--build", folder / build), "pbs was built with Eigen's alignment of 16 bytes")

    def test_nothing_names_the_source_tree(self):
        texts = [name for name in installation.files_naming(prefix, SOURCE) if not name.endswith(".a")]
        self.assertEqual(texts, [])

    def test_components_and_versions_that_are_not_installed_are_named(self):
        for name, components, version, words in (
                ("absent", "REQUIRED COMPONENTS method fem", "", "component 'fem' is not installed under"),
                ("unknown", "REQUIRED COMPONENTS skin", "", "there is no component 'skin': expected one of "
                                                            "method, meshes"),
                ("later", "REQUIRED", "99.0", 'compatible with requested version "99.0"')):
            with self.subTest(name):
                self.refused(asking_for(name, components, version), words)

    def test_an_optional_component_that_is_not_installed(self):
        asked = self.succeeds(asking_for("optional", "OPTIONAL_COMPONENTS fem COMPONENTS method"))
        self.assertRegex(asked.stdout, "found (TRUE|1)")


if __name__ == "__main__":
    if not shutil.which("ninja"):
        raise SystemExit("ninja is not there")
    unittest.main()
