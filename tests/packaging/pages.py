"""Manual pages, manual of scene files and completions: every verb, option and scene key is in them, and the shells
accept them.

Reference: `pbskin --help` and `pbskin VERB --help`, which CLI11 writes, not the description from which the pages were
written; the schema's own answer to an unknown key; mandoc, a reader of manual pages; and bash and zsh themselves.
"""
import os
import re
import shutil
import subprocess
import unittest

from installation import BUILD, SOURCE, folder, run

PBSKIN = BUILD / "bin/pbskin"
pages = BUILD / "pages"


def help_of(*verb):
    return run(PBSKIN, *verb, "--help").stdout


def verbs():
    return re.findall(r"^  ([a-z]\w*) ", help_of().split("Subcommands:")[1], re.MULTILINE)


def options(*verb):
    lines = re.findall(r"^  (-[^ ]+)", help_of(*verb), re.MULTILINE)
    return [name for line in lines for name in line.split(",")]


def completed(*words):
    """COMPREPLY after `pbskin WORDS` and the tab key."""
    script = (f'source "{pages / "pbskin"}"; COMP_WORDS=(pbskin "$@"); COMP_CWORD=$#; _pbskin; '
              'printf "%s\\n" "${#COMPREPLY[@]}" "${COMPREPLY[@]}"')
    environment = {**os.environ, "PATH": f"{PBSKIN.parent}:{os.environ['PATH']}"}
    number, *replies = run("bash", "-c", script, "bash", *words, env=environment, cwd=folder).stdout.splitlines()
    return replies[:int(number)]


class ManPage(unittest.TestCase):
    def setUp(self):
        self.text = (pages / "pbskin.1").read_text(encoding="utf-8").replace("\\-", "-")

    def test_every_verb_and_option(self):
        self.assertGreaterEqual(len(verbs()), 9)
        for verb in verbs():
            self.assertIn(f".SS {verb}\n", self.text)
            section = self.text.split(f".SS {verb}\n")[1].split(".SS ")[0]
            for name in options(verb):
                self.assertIn(f"\\fB{name}\\fR", section, f"{verb} {name}")
        self.assertNotIn("--describe", self.text)  # a hidden option

    @unittest.skipUnless(shutil.which("mandoc"), "mandoc is not installed")
    def test_readers_take_it(self):
        for page in ("pbskin.1", "pbskin-scene.5"):
            checked = run("mandoc", "-Tlint", "-Wwarning", pages / page)
            self.assertEqual(checked.stdout + checked.stderr, "")
        shown = re.sub(".\b", "", run("mandoc", "-Tascii", pages / "pbskin.1").stdout)  # overstruck characters are bold
        self.assertIn("pbskin measure REST [FRAME ...]", shown)


class SceneManual(unittest.TestCase):
    def rows(self):
        """Table -> keys of the installed manual."""
        sections = re.split(r"^## ", (SOURCE / "experiments/scene/manual.md").read_text(encoding="utf-8"),
                            flags=re.MULTILINE)[1:]
        return {section.split("\n")[0].strip("[]"): re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)
                for section in sections}

    def test_the_committed_manual_is_current(self):
        self.assertEqual((SOURCE / "experiments/scene/manual.md").read_text(encoding="utf-8"),
                         (pages / "scene_manual.md").read_text(encoding="utf-8"),
                         f"cp {pages}/scene_manual.md experiments/scene/manual.md")

    def test_the_program_explains_every_key_of_it(self):
        keys = [key if table == "Top level" else f"{table}.{key}" for table, names in self.rows().items()
                for key in names]
        self.assertGreater(len(keys), 50)
        for table in ("pbs", "fem", "output"):
            explained = re.findall(r"^(\S+) \(scene key\)", run(PBSKIN, "explain", table).stdout, re.MULTILINE)
            self.assertEqual(sorted(explained), sorted(key for key in keys if key.rpartition(".")[0] == table))

    def test_the_manual_page_has_the_same_keys(self):
        text = (pages / "pbskin-scene.5").read_text(encoding="utf-8")
        for names in self.rows().values():
            for key in names:
                self.assertIn(f"\n.TP\n\\fB{key}\\fR\n", text)


class Bash(unittest.TestCase):
    def test_verbs(self):
        self.assertEqual(sorted(completed("")), sorted(verbs()))
        self.assertEqual(completed("rep"), [verb for verb in verbs() if verb.startswith("rep")])

    def test_options_of_each_verb(self):
        for verb in verbs():
            self.assertEqual(sorted(completed(verb, "-")), sorted(options(verb)), verb)

    def test_choices_names_and_files_but_none_for_a_number(self):
        (folder / "own scene.toml").write_text("")
        for words, replies in (("list sc", ["scenes"]), ("run limb_t", ["limb_twist"]), ("run own", ["own scene.toml"]),
                               ("measure own", ["own scene.toml"]), ("run limb_twist -o own", ["own scene.toml"]),
                               ("run limb_twist --threads ", [])):
            with self.subTest(words):
                self.assertEqual(completed(*words.split(" ")), replies)
        self.assertEqual(completed("explain", "C0")[0], "C01")


@unittest.skipUnless(shutil.which("zsh"), "zsh is not there")
class Zsh(unittest.TestCase):
    def test_every_verb_and_option(self):
        text = (pages / "_pbskin").read_text(encoding="utf-8")
        for verb in verbs():
            self.assertIn(f"'{verb}:", text)
            line = next(line for line in text.split("\n") if line.strip().startswith(f"{verb}) "))
            for name in options(verb):
                self.assertRegex(line, rf"'\*?{re.escape(name)}\[", f"{verb} {name}")

    def test_it_is_loaded_as_the_completion_of_pbskin(self):
        script = (f"fpath=({pages} $fpath); autoload -Uz compinit; compinit -u -D; autoload +X _pbskin; print -r -- "
                  "$_comps[pbskin]")
        loaded = subprocess.run(["zsh", "-f", "-c", script], capture_output=True, text=True, timeout=60)
        self.assertEqual((loaded.stdout.strip(), loaded.stderr), ("_pbskin", ""))


if __name__ == "__main__":
    unittest.main()
