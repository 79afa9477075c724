"""The name, the colour and the marker of each deformer. Reference: looks.toml, with which checked_looks.py compares
every figure that other tests draw."""
import pathlib
import re
import tomllib
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
                whole = {"name", "group"} if "group" in entry else {"name", "color", "marker", "line"}
                self.assertEqual(set(entry) - {"short"}, whole)
                self.assertRegex(looks.of(name).color, r"^#[0-9A-F]{6}$")
        self.assertEqual(len({(entry["color"], entry["marker"]) for entry in own.values()}), len(own))

    def test_each_method_of_the_comparison_has_a_name_and_those_that_are_drawn_a_look_of_their_own(self):
        compared = tomllib.loads((root / "experiments/studies/work_precision/cases.toml").read_text(encoding="utf-8"))[
            "method"]
        self.assertLessEqual({method["name"] for method in compared}, set(looks.listed))
        drawn = [looks.of(method["name"]) for method in compared if "known" in method["tables"]]
        self.assertEqual(len({look.color for look in drawn}), 12)

    def test_a_deformer_that_is_not_listed_has_its_name_and_a_look_that_depends_on_nothing_else(self):
        listed = {entry.get("color") for entry in looks.listed.values()}
        self.assertFalse(listed & {color for color, _, _ in looks.own})
        # These are the colours of what is no deformer.
        self.assertFalse(listed & {color for color in looks.palette.values() if isinstance(color, str)})
        first = looks.of("mine")
        for other in ("other_one", "linked"):
            self.assertNotEqual(looks.of(other), first)
        self.assertEqual((looks.of("mine"), first.name), (first, "mine"))

    def test_a_figure_with_strange_colours_or_letters_or_labels_that_overlap_is_refused(self):
        def drawn(color=style.indigo, size=style.label_size, apart=0.3):
            figure, ((axes,),) = style.panels(1, 1)
            axes.plot([0, 1], [0, 1], color=color)
            axes.annotate("one", (0.5, 0.5), fontsize=size)
            axes.annotate("other", (0.5, 0.5 - apart))
            self.addCleanup(style.pyplot.close, figure)
            return figure

        checks = {"color": checked_looks.strange_colors, "size": checked_looks.strange_sizes,
                  "apart": checked_looks.overlaps}
        for broken, found in ({"color": "#123456"}, ["#123456"]), ({"size": 9.0},
                                                                   [9.0]), ({"apart": 0.0}, ["one | other"]):
            for name, check in checks.items():
                self.assertEqual(check(drawn(**broken)), found if name in broken else [], (name, broken))
            with self.assertRaisesRegex(AssertionError, "^broken: .*" + re.escape(str(found[0]))):
                style.save(drawn(**broken), pathlib.Path("broken"), {}, [])

    def test_labels_are_as_near_as_possible_to_their_lines(self):
        self.assertEqual(style.spread([1, 5, 9], [2, 2, 2], 0, 10), [1, 5, 9])
        self.assertEqual(style.spread([5, 5, 9], [2, 2, 2], 0, 10), [4, 6, 9])
        self.assertEqual(style.spread([5, 9.5, 9.5], [1, 2, 2], 0, 10), [5, 7, 9])
        self.assertEqual(style.spread([], [], 0, 10), [])

    def test_the_names_are_those_of_the_pages(self):
        for deformer in looks.listed:
            self.assertEqual(case_words.of_field("deformer", deformer), looks.of(deformer).name)

    def test_no_script_has_a_colour_of_a_deformer_of_its_own(self):
        named = re.compile(
            r"""["'](lbs|dqs|pbs|xpbd|vbd|nh_p[12]|delta_mush)["']\s*:\s*\(?[^\n]*(#[0-9A-Fa-f]{6}|style\.\w+)""")
        for file in (root / "paper_figures").rglob("*.py"):
            self.assertIsNone(named.search(file.read_text(encoding="utf-8")), file)

    def test_a_line_of_a_deformer_in_another_colour_is_found(self):
        figure, axes = style.panels(1, 1)
        look = looks.of("dqs")
        axes[0][0].plot([0, 1], [0, 1], color=look.color, marker=look.marker, label="DQS")
        self.assertEqual(checked_looks.wrongly_drawn(figure), [])
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS, 90 degrees")
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS (baseline)")
        axes[0][0].plot([0, 1], [0, 1], color=style.ink, marker=look.marker, label="DQS-like")
        self.assertEqual(checked_looks.wrongly_drawn(figure),
                         ["DQS, 90 degrees: #262626 s", "DQS (baseline): #262626 s"])


if __name__ == "__main__":
    unittest.main()
