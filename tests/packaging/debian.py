"""The Debian packages are built, inspected, unpacked elsewhere and run. This takes long: a separate build without this
machine's instructions.

Reference: dpkg's own tools, and the packages' contents as users get them.
"""
import os
import re
import sys
import unittest

import installation
from installation import CMAKE, SOURCE, folder, run

packages = SOURCE / "build/package/packages"
root = folder / "root"


class Debian(installation.BuildTest):
    @classmethod
    def setUpClass(cls):
        for file in packages.glob("*.deb"):
            file.unlink()
        made = run(CMAKE, "--workflow", "--preset", "package", cwd=SOURCE)
        if made.returncode != 0:
            raise RuntimeError(made.stdout[-3000:] + made.stderr[-3000:])
        cls.debs = {file.name.split("_")[0]: file for file in packages.glob("*.deb")}
        for deb in cls.debs.values():
            run("dpkg-deb", "-x", deb, root, check=True)

    def build_consumer(self, project, build):
        source = SOURCE / "tests/packaging" / project
        self.build(installation.configured(source, build, f"-DCMAKE_PREFIX_PATH={root / 'usr'}"), build)

    def field(self, package, name):
        return run("dpkg-deb", "-f", self.debs[package], name).stdout.strip()

    def test_two_packages(self):
        self.assertEqual(sorted(self.debs), ["libpbs-dev", "pbskin"])

    def test_what_they_depend_on(self):
        needs = re.findall(r"[\w.+-]+", re.sub(r"\([^)]*\)", "", self.field("pbskin", "Depends")))
        for name in ("libc6", "libstdc++6", "libdeal.ii-9.4.1", "libgsl27", "libfmt9", "libspdlog1.10-fmt9"):
            self.assertIn(name, needs)
        self.assertFalse([name for name in needs if name.endswith("-dev")])
        self.assertEqual(self.field("libpbs-dev", "Depends"), "libeigen3-dev, libtbb-dev")
        self.assertLessEqual({"snakemake", "slurm-client"}, set(self.field("pbskin", "Suggests").split(", ")))

    def test_all_under_usr_and_owned_by_root(self):
        for deb in self.debs.values():
            for line in run("dpkg-deb", "-c", deb).stdout.splitlines():
                self.assertRegex(line, r"^[-dl][rwx-]{9} root/root +\d+ \S+ \S+ \./(usr/?.*)?$")

    def test_the_program_runs_where_it_was_unpacked(self):
        self.succeeds(run(root / "usr/bin/pbskin", "list", "scenes", cwd=folder))
        small = ("--set", "motion.frames=2", "--set", "motion.angle_deg=20", "--set", "character.vertices=500")
        self.succeeds(run(root / "usr/bin/pbskin", "run", "limb_twist", "-o", "twist", *small, cwd=folder))

    def test_libraries_are_found_by_a_consumer(self):
        self.build_consumer("method_consumer", "consumer")
        self.assertIn("tets 1920", run(folder / "consumer/bent_bar").stdout)

    def test_every_component_is_called(self):
        """Flesh that is held by one moved tet follows it, up to the rounding of its solve; 1e-11 m were observed."""
        self.build_consumer("components_consumer", "all")
        told = self.succeeds(run(folder / "all/moved_limb", cwd=folder))
        match = re.fullmatch(r"tets (\d+), bones (\d+), moved to within (\S+) m, volume change (\S+) %\n", told.stdout)
        self.assertTrue(match, told.stdout)
        tets, bones, error_m, volume_change_pct = map(float, match.groups())
        self.assertGreater(tets, 500)
        self.assertGreaterEqual(bones, 2)
        self.assertLess(error_m, 1e-9)
        self.assertLess(abs(volume_change_pct), 1e-7)

    def test_a_native_build_is_refused(self):
        script = (SOURCE / "cmake/package/portable_only.cmake").resolve()
        self.refused(run(CMAKE, "-DCPACK_PBS_NATIVE=ON", "-P", script), "PBS_NATIVE = ON")


if __name__ == "__main__":
    if not os.environ.get("PBS_LONG"):
        sys.exit(77)
    unittest.main()
