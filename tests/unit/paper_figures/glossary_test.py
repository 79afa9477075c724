"""Every term has one short sentence, a page has a link from the first use of each, and experiments/GLOSSARY.md is
current. Reference: the definition, and the order of the alphabet."""
import re
import unittest

from results_case import root
from readme import part, tables
from report.markup import Markup
from words import glossary


class Terms(unittest.TestCase):
    def test_each_is_listed_once_with_one_short_sentence(self):
        names, slugs = ([getattr(entry, field) for entry in glossary.entries()] for field in ("name", "slug"))
        self.assertEqual(names, sorted(names, key=str.lower))
        words = [word.lower() for entry in glossary.entries() for word in (entry.name, *entry.also)]
        self.assertEqual((len(set(slugs)), len(set(words))), (len(names), len(words)))
        for entry in glossary.entries():
            with self.subTest(entry.name):
                self.assertLessEqual(len(entry.sentence.split()), 25)
                self.assertRegex(entry.sentence, r"^[\w].*[^.]\.$")

    def test_the_page_is_current_and_its_picture_small(self):
        self.assertEqual(part.cut(tables.glossary_page, "glossary")[1].splitlines()[1:], tables.glossary_lines(),
                         "python3 paper_figures/make_readme.py experiments/records/full glossary")
        self.assertLess(tables.glossary_page.with_name("glossary.svg").stat().st_size, 60_000)
        self.assertIn("(experiments/GLOSSARY.md)", (root / "README.md").read_text(encoding="utf-8"))


class Links(unittest.TestCase):
    def linked(self, text, seen=()):
        """The slugs and words of the links, and the text without them."""
        whole = glossary.linked(Markup(text), set(seen))
        self.assertIsInstance(whole, Markup)
        link = r'<a class="term" href="#term-([\w-]+)" title="[^"<>]+\.">(.*?)</a>'
        return re.findall(link, whole), re.sub(link, r"\2", whole)

    def test_the_first_use_of_each_is_a_link_and_the_text_stays(self):
        text = ("<p>Tets, XPBD and PBS-like tets: the\nreference&#x27;s own error of PBS, then PBS; poisson\u2019s "
                "ratio, pbs.k_stretch</p>")
        self.assertEqual(self.linked(text),
                         ([("tet", "Tets"), ("bound-of-the-references-error", "reference&#x27;s own error"),
                           ("pbs", "PBS"), ("poissons-ratio", "poisson\u2019s ratio")], text))
        self.assertEqual(self.linked("tet <b>Tet</b> LBS", ["lbs"]), ([("tet", "tet")], "tet <b>Tet</b> LBS"))

    def test_none_is_in_a_tag_a_link_code_or_a_heading(self):
        for text in ('<img alt="PBS">', "<a href='x'><b>PBS</b></a>", "<code>PBS</code>",
                     "<h2 id='a'>PBS <i>tet</i></h2>"):
            self.assertEqual(self.linked(text + "<hr/>PBS"), ([("pbs", "PBS")], text + "<hr/>PBS"))


if __name__ == "__main__":
    unittest.main()
