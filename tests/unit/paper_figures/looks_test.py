"""Tests of the deformers' looks. Reference: looks.toml itself. checked_looks.py compares with it every figure that the other tests draw."""
import re
import unittest

from results_case import root
import checked_looks
from drawing import style
from words import case_words, looks

class Looks(unittest.TestCase):
    def test_each_entry_is_whole_and_each_group_has_a_look_of_its_own(self):
        own = {name: entry for name, entry in looks.listed.items() if "group" not in entry}
        for name, entry in looks.listed.items():
            with self.subTest(name):
                self.assertIn(entry.get("group", name), own)
                self.assertEqual(set(entry), {"name", "group"} if "group" in entry else {"name", "color", "marker", "line"})
                self.assertRegex(looks.of(name).color, r"^#[0-9A-F]{6}$")
        self.assertEqual(len({(entry["color"], entry["marker"]) for entry in own.values()}), len(own))

    def test_a_deformer_that_is_not_listed_has_its_name_and_a_look_that_depends_on_nothing_else(self):
        listed = {entry.get("color") for entry in looks.listed.values()}
        self.assertFalse(listed & {color for color, _, _ in looks.own})
        first = looks.of("mine")
        for other in ("other_one", "linked"):
            self.assertNotEqual(looks.of(other), first)
        self.assertEqual((looks.of("mine"), first.name), (first, "mine"))

    def test_the_names_are_those_of_the_pages(self):
        for deformer in looks.listed:
            self.assertEqual(case_words.of_field("deformer", deformer), looks.of(deformer).name)

    def test_no_script_has_a_colour_of_a_deformer_of_its_own(self):
        named = re.compile(r"""["'](lbs|dqs|pbs|xpbd|vbd|nh_p[12]|delta_mush)["']\s*:\s*\(?[^\n]*(#[0-9A-Fa-f]{6}|style\.\w+)""")
        for file in (root / "paper_figures").rglob("*.py"):
            self.assertIsNone(named.search(file.read_text(encoding="utf-8")), file)

    def test_a_line_of_a_deformer_in_another_colour_is_found(self):
        figure, axes = style.panels(1, 1)
        look = looks.of("dqs")
        axes[0][0].plot([0, 1], [0, 1], color=look.color, marker=look.marker, label="DQS")
        self.assertEqual(checked_looks.wrongly_drawn(figure), [])
        axes[0][0].plot([0, 1], [0, 1], color=style.black, marker=look.marker, label="DQS, 90 degrees")
        self.assertEqual(checked_looks.wrongly_drawn(figure), ["DQS, 90 degrees: #000000 s"])


if __name__ == "__main__":
    unittest.main()
