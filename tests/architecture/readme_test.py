"""The README is short, its picture and its links exist, and so do those of every other page. Reference: the files of
the source tree."""
import os
import pathlib
import re
import struct
import tempfile
import unittest

source = pathlib.Path(__file__).resolve().parents[2]
longest, widest_px, largest_bytes = 130, 1800, 300_000
foreign = ("build", "results", "node_modules", "full", ".git")  # folders whose pages are not written by hand


def pages():
    found = []
    for folder, below, files in os.walk(source):
        below[:] = [name for name in below if name not in foreign]
        found += [pathlib.Path(folder, name) for name in files if name.endswith(".md")]
    return found


def prose_of(page):
    """The text without blocks of code, in which brackets have another meaning."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)


def links_of(page):
    return [target for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", prose_of(page)))
            if "://" not in target]


def anchors_of(page):
    """The anchors as GitHub makes them: lower case, blanks to hyphens, punctuation left out."""
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
            for title in re.findall(r"^#+ (.*)$", prose_of(page), re.MULTILINE)}


def broken_links(page):
    """Links within the source tree whose file, folder or heading does not exist."""
    broken = []
    for link in links_of(page):
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        if not target.exists() or (anchor and (target.suffix != ".md" or anchor not in anchors_of(target))):
            broken.append(f"{page}: {link}")
    return broken


class Versions(unittest.TestCase):
    def test_the_citation_and_the_changelog_name_the_version_of_the_build(self):
        build, citation, changelog = ((source / name).read_text(encoding="utf-8")
                                      for name in ("CMakeLists.txt", "CITATION.cff", "CHANGELOG.md"))
        version, = re.findall(r"^project\(\S+ VERSION (\d+\.\d+\.\d+) ", build, re.MULTILINE)
        self.assertIn(f"version: {version}\n", citation)
        heading = re.search(r"^## .*$", changelog, re.MULTILINE)[0]
        self.assertIn(version, re.findall(r"\d+\.\d+\.\d+", heading), "the topmost section of CHANGELOG.md")


class Readme(unittest.TestCase):
    readme = source / "README.md"

    def test_it_is_short(self):
        self.assertLessEqual(len(self.readme.read_text(encoding="utf-8").splitlines()), longest)

    def test_its_pictures_are_light(self):
        pictures = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", prose_of(self.readme))
        self.assertGreaterEqual(len(pictures), 1)
        for picture in pictures:
            self.assertLess((source / picture).stat().st_size, largest_bytes, picture)
            width_px, = struct.unpack(">I", (source / picture).read_bytes()[16:20])  # from the first chunk of a PNG
            self.assertLessEqual(width_px, widest_px, picture)

    def test_every_link_of_every_page_leads_somewhere(self):
        self.assertGreater(len(links_of(self.readme)), 15)
        self.assertEqual([link for page in pages() for link in broken_links(page)], [])


class LinkCheck(unittest.TestCase):
    def test_dead_links_are_found_and_others_are_not(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder, "page.md")
            page.write_text("# A page: its title\n[a](page.md) [b](#a-page-its-title) [c](page.md#a-page-its-title) "
                            "[d](.)\n"
                            "[e](https://example.org) `[f](none.md)`\n```\n# no heading\n[g](none.md)\n```\n"
                            "[h](none.md) [i](#no-heading) [j](page.md#none) ![k](none.png)\n")
            dead = [link.rpartition(": ")[2] for link in broken_links(page)]
        self.assertEqual(dead, ["none.md", "#no-heading", "page.md#none", "none.png"])


if __name__ == "__main__":
    unittest.main()
