"""The documentation of the headers builds without a warning and contains the headers' comments. This takes long.

Reference: the headers themselves; a page is what Doxygen makes of the output of cmake/documentation/comments.awk.
"""
import html
import os
import re
import shutil
import sys
import unittest

from installation import BUILD, CMAKE, SOURCE, run


def words_of(page):
    text = (BUILD / "doc/html" / page).read_text(encoding="utf-8")
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", text)).split())


class Documentation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.built = run(CMAKE, "--build", BUILD, "--target", "doc")

    def test_no_warning(self):
        self.assertEqual(self.built.returncode, 0, self.built.stdout[-3000:])

    def test_comments_are_on_the_pages(self):
        for what, page, words in (
                ("shapes and units", "classpbs_1_1PbsSolver.html", "bind_points are the posed q_i [m], #V x 3"),
                ("comments behind members", "structpbs_1_1PbsOptions.html",
                 "stop when the largest of the three residuals is below"),
                ("sources", "blend_8hpp.html", "Kavan, Collins, Zara, O'Sullivan"),
                ("errors", "input__error_8hpp.html", "file, line, field, value and the rule it breaks"),
                ("main page", "index.html", "Position Based Skinning")):
            with self.subTest(what):
                self.assertIn(words, words_of(page))

    def test_every_installed_header_has_a_page(self):
        files = words_of("files.html")
        for folder in ("pbs", "reference_fem", "analysis"):
            for header in (SOURCE / folder).rglob("*.hpp"):
                self.assertIn(f" {header.name} ", f" {files} ")


if __name__ == "__main__":
    if not os.environ.get("PBS_LONG"):
        sys.exit(77)
    if not shutil.which("doxygen"):
        sys.exit("doxygen is not there")
    unittest.main()
