"""The README and the pages state what the kept records have, and the verdicts of the kept records are those on record
by the thresholds of claims.toml: they change only with new records or another rule. Every study and every claim has its
page, with the required sections, whose generated part is current. `pbskin explain` prints each page, and those of
deformers. README, page, report, `pbskin explain` and the tables of the program have the verdicts and numbers of
claims.json. The files and columns that the pages quote are those of the kept records. Reference: the kept records,
claims.toml and figures.toml."""
import csv
import fnmatch
import functools
import html
import os
import pathlib
import re
import shutil
import sys
import tempfile
import types
import unittest

import program

SOURCE = pathlib.Path(program.SOURCE)
sys.path.insert(0, str(SOURCE / "paper_figures"))
# noqa: E402.
from readme import findings as readme_findings, pages as readme_pages, part as readme_part, tables as readme_tables
from records import kept  # noqa: E402
from report import verdicts as report_verdicts  # noqa: E402
from words import sentences  # noqa: E402

RECORDS = SOURCE / "experiments" / "records" / "full"
KEPT = kept.opened(RECORDS)
STUDY_SECTIONS = ["Cases", "Records", "Claims, figures, cost", "What it cannot show"]
CLAIM_SECTIONS = ["What the paper says", "What was measured", "What would refute it", "What it depends on", "Result"]
MOST_WORDS = 150  # of a claim's page, without its generated part
MOST_WORDS_OF_A_SENTENCE = 45  # that the generator writes
WRITTEN = {"metrics.csv", "measurements.csv", "printed.csv"}  # these files are written by runs


def sections(text):
    return re.findall(r"^## (.+)$", text, re.MULTILINE)


def quoted_columns(text):
    """File and columns of each row of the table below `## Records`."""
    table = text.split("## Records\n", 1)[1].split("\n## ", 1)[0]
    for line in re.findall(r"^\| `.*$", table, re.MULTILINE):
        files, _, columns = (cell.strip() for cell in line.strip("|").split("|"))
        for file in re.findall(r"`([^`]+)`", files):
            yield file, re.findall(r"`(\w+)`", columns)


def kept_tables(study, file):
    """The kept tables that a name matches; capital letters in it match any text."""
    pattern = re.sub(r"[A-Z][A-Z_]+", "*", file)
    return [table for table in (KEPT / study).rglob("*.csv") if fnmatch.fnmatch(str(table.relative_to(KEPT / study)),
                                                                                pattern)]


def told(value):
    """A pattern of the number in three digits, of thousands in all of them; a censored one may have a sign in front."""
    digits = "|".join({f"{value:.3g}".replace("+", r"\+")} | ({f"{value:.0f}", f"{value:,.0f}"}
                                                              if 1000 <= abs(value) < 1e6 else set()))
    return rf"(?:(?:[<>]=?|[\u2264\u2265]) )?(?:{digits})(?![\d.,]*\d)"


def counts_of(claim):
    """Patterns of how many cases hold, and their share with its interval."""
    if claim["rule"] == "printed":
        return [rf"\b{claim['held']} of {claim['n']} printed values"]
    if claim["rule"] != "cases" or not claim["n"]:
        return []
    share, low, high = (f"{claim[name]:.3g}" for name in ("share", "interval_low", "interval_high"))
    return [rf"\b{claim['held']} of {claim['n']} (?:cases? )?hold, share {share} \[{low}, {high}\]"]


def numbers_of(claim):
    """Patterns of the least and the most of the cases' numbers."""
    return [] if claim["least"] is None else [f": {told(claim['least'])}", f"(?:to|:) {told(claim['most'])}"]


def range_of(claim):
    """A pattern of the range by which a single number is judged."""
    return [rf"\({claim['range']}: {told(case['low'])} to {told(case['high'])}\)" for case in claim["cases"]
            if claim["rule"] == "single"]


def spoken(verdict):
    return {"untestable": "cannot be tested"}.get(verdict, verdict.replace("_", " "))


def own_part(text, name):
    """What a page states of one claim, which may be one of two on it, in one line."""
    own = re.split(rf"^(?:\*\*)?{name}: ", text, flags=re.MULTILINE)[-1]
    return " ".join(re.split(r"^(?:\*\*)?C\d", own, flags=re.MULTILINE)[0].split())


@functools.cache
def explained(name):
    """The finished process of `pbskin explain NAME`."""
    return program.run("explain", name)


@functools.cache
def header(table):
    with table.open(newline="", encoding="utf-8") as rows:
        return next(csv.reader(rows))


class Pages(program.ProgramTest):
    def studies(self):
        return [line.split()[0] for line in self.succeeds("list", "studies").stdout.splitlines()
                if re.match("  [a-z]", line)]

    def claims(self):
        return {claim["id"]: claim for claim in readme_pages.listed_claims()}

    def explained(self, name):
        process = explained(name)
        self.assertEqual(process.returncode, 0, process.stderr)
        return " ".join(process.stdout.split())

    def test_each_study_has_a_readme_with_the_sections(self):
        self.assertEqual(sorted(self.studies()), readme_pages.study_names())
        for study in self.studies():
            text = (readme_pages.studies / study / "README.md").read_text(encoding="utf-8")
            with self.subTest(study):
                self.assertTrue(text.startswith(f"# {study}\n\n"))
                self.assertIn("?", text.split("\n\n")[1], "the first paragraph asks the study's question")
                self.assertEqual(sections(text), STUDY_SECTIONS)

    def test_each_claim_has_a_page_of_few_words_with_the_sections(self):
        self.assertEqual(sorted(page.stem for page in readme_pages.claim_pages.glob("*.md")),
                         sorted({sentences.page_of(claim) for claim in self.claims()}))
        for page in readme_pages.claim_pages.glob("*.md"):
            text = page.read_text(encoding="utf-8")
            with self.subTest(page.stem):
                self.assertTrue(text.startswith(f"# {page.stem}: "))
                self.assertEqual(sections(text), CLAIM_SECTIONS)
                self.assertLessEqual(len(re.findall(r"\S*\w\S*", readme_part.cut(page, "kept")[0])), MOST_WORDS)

    def test_the_program_prints_every_page(self):
        """The pages are those of studies, of claims, and of the deformers that have one."""
        folder = SOURCE / "experiments" / "deformers"
        pages = {page.stem: page for page in folder.glob("*.md") if page.stem != "README"}
        pages |= {page.parent.name: page for page in folder.glob("*/README.md")}
        self.assertLessEqual({"pbs_author", "external"}, set(pages))
        pages |= {study: readme_pages.studies / study / "README.md" for study in self.studies()}
        pages |= {claim: readme_pages.claim_pages / f"{sentences.page_of(claim)}.md" for claim in self.claims()}
        for name, page in sorted(pages.items()):
            printed = self.explained(name)
            for section in sections(page.read_text(encoding="utf-8")):
                self.assertIn(section, printed, name)
        self.assertIn("reproduce --full:", self.explained("volume"))

    def test_quoted_files_and_columns_are_on_record(self):
        for study in self.studies():
            if not (KEPT / study).is_dir():  # frames: its records are large, and no verdict needs them
                continue
            rows = list(quoted_columns((readme_pages.studies / study / "README.md").read_text(encoding="utf-8")))
            self.assertTrue(rows, study)
            for file, columns in rows:
                with self.subTest(f"{study}/{file}"):
                    tables = kept_tables(study, file)
                    left_out = not tables and f"`{file}`" in " ".join(readme_pages.not_kept(study, KEPT))
                    self.assertTrue(tables or left_out, "no such table among the kept records")
                    self.assertFalse([of for of in columns
                                      if not (left_out or any(of in header(table) for table in tables))])

    def test_each_column_on_record_is_explained(self):
        """By columns.md under the name of the study or for all of them; `pbskin explain` has those of metrics.csv."""
        page = (SOURCE / "experiments" / "records" / "columns.md").read_text(encoding="utf-8")
        explained = {title: re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`[^|]+) \|", text, re.M)))
                     for title, text in re.findall(r"^## (.+)$([^#]+)", page, re.M)}
        for study in self.studies():
            names = [re.sub("[A-Z]+", r"[\\w.]+", name) for name in explained["All studies"] + explained.get(study, [])]
            pattern = re.compile(rf"({'|'.join(names)})(_low|_high|_lower|_upper)?")
            for table in (KEPT / study).rglob("*.csv"):
                if table.name not in ("metrics.csv", "frame_statistics.csv", "not_kept.csv"):
                    with self.subTest(table.relative_to(KEPT)):
                        self.assertEqual([column for column in header(table) if not pattern.fullmatch(column)], [])

    def test_the_table_of_features_is_that_of_the_kept_records(self):
        _, told, _ = readme_part.cut(readme_tables.features_page, "features")
        self.assertEqual(told.splitlines()[1:], readme_tables.features_lines(KEPT))

    def test_names_that_the_tables_of_places_quote_are_in_their_files(self):
        for folder in ("experiments", "reference_fem"):
            page = SOURCE / folder / "README.md"
            rows = page.read_text(encoding="utf-8").split("## Where is it?\n\n")[1].split("\n\n")[0].splitlines()[2:]
            for row in rows:
                files = [page.parent / file for file in re.findall(r"\]\(([^)]+)\)", row)]
                texts = [file.read_text(encoding="utf-8") for file in files if file.is_file()]
                for name in re.findall(r"`(?:\w+::)?(\w+)`", row.split(" | ")[-1]):
                    self.assertTrue(not texts or any(name in text for text in texts) or any(page.parent.rglob(name)),
                                    row)

    def test_files_named_by_the_readmes_of_experiments_are_there(self):
        for folder in ("", "deformers", "verdicts"):
            page = SOURCE / "experiments" / folder / "README.md"
            for name in re.findall(r"`([\w./]+\.(?:cpp|hpp|toml|py|csv))`", page.read_text(encoding="utf-8")):
                places = [page.parent / name, SOURCE / name]
                found = any(place.exists() for place in places) or (name.count("/") == 0
                                                                    and any(page.parent.rglob(name)))
                self.assertTrue(found or name in WRITTEN, f"{page.relative_to(SOURCE)}: {name}")


class KeptVerdicts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """A copy of the kept records, judged."""
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.judged = pathlib.Path(temporary.name, "kept")
        shutil.copytree(RECORDS, cls.judged)
        (cls.judged / "claims.md").unlink()
        judging = program.run("reproduce", "--judge", "-o", cls.judged, "--quiet",
                              env={**os.environ, "COLUMNS": "1000"})
        if judging.returncode != 0:
            raise RuntimeError(judging.stdout + judging.stderr)
        cls.printed = judging.stdout  # in lines that are not wrapped

    def test_records_beside_the_sources_give_the_verdicts_on_record(self):
        self.assertEqual((self.judged / "claims.md").read_text(), (RECORDS / "claims.md").read_text())

    def test_every_claim_is_on_record_with_the_revision_that_fixed_its_rule(self):
        claims = sentences.claims_of(self.judged / "claims.json")
        self.assertEqual([claim["id"] for claim in claims if not re.fullmatch(r"[0-9a-f]{40}", claim["fixed_at"])], [])
        self.assertEqual([claim["id"] for claim in claims], [claim["id"] for claim in readme_pages.listed_claims()])

    def test_every_text_has_the_verdict_and_the_numbers_of_claims_json_in_its_place(self):
        readme, listed = (file.read_text(encoding="utf-8")
                          for file in (SOURCE / "README.md", self.judged / "claims.md"))
        for claim in sentences.claims_of(self.judged / "claims.json"):
            name, kind, word = claim["id"], claim["verdict"], spoken(claim["verdict"])
            later = claim["held_out"] and spoken(claim["held_out"]["verdict"])
            both = f"{word}; on the held-out cases: {later}" if later else word
            page = readme_part.cut(readme_pages.claim_pages / f"{sentences.page_of(name)}.md", "kept")[1]
            counts, numbers, span = counts_of(claim), numbers_of(claim), range_of(claim)
            line = report_verdicts.line(claim, types.SimpleNamespace(results=self.judged), None, [])
            for place, text, patterns in (
                    ("README", re.search(rf"^\| \[{name}\]\(.*$", readme, re.M)[0], [rf"\| {word} \|"]),
                    ("page", own_part(page, name), [rf"^{both}\.\*\*", *counts, *numbers, *span]),
                    ("explain", own_part(explained(name).stdout, name), [rf"^{both}\. ", *counts, *numbers, *span]),
                    ("report", html.unescape(line), [f"</span> {word}</span>", *counts, *numbers, *span]),
                    ("claims.md", re.search(rf"^\| {name} \|.*$", listed, re.M)[0], [rf"\| {kind} \|", *numbers]),
                    ("terminal", re.search(rf"^{name} .*$", self.printed, re.M)[0],
                     [rf"^{name} +{re.escape(claim['short'])} +{kind.replace('_', ' ').upper().split(' IN ')[0]} +"
                      rf"{re.escape(claim['measured'])}$"])):
                for pattern in patterns:
                    with self.subTest(f"{name} {place}"):
                        self.assertRegex(text.replace("\u2212", "-"), pattern)

    def test_judging_them_where_they_lie_leaves_nothing_that_git_would_see(self):
        ignored = (SOURCE / ".gitignore").read_text().splitlines()
        before, after = ({file.relative_to(folder) for file in folder.rglob("*")} for folder in (RECORDS, self.judged))
        for file in after - before:
            self.assertIn(f"/experiments/records/full/{file}", ignored)

    def test_pages_and_readme_state_each_claim_and_finding_as_the_records_have_it(self):
        judged = kept.opened(self.judged)
        for page, lines in readme_pages.pages(judged).items():
            with self.subTest(page.relative_to(SOURCE)):
                self.assertEqual(readme_part.cut(page, "kept")[1].splitlines()[1:], lines,
                                 "python3 paper_figures/make_readme.py writes it")
                for sentence in re.split(r"(?<=[.?!]) +|\n",
                                         re.sub(r"^\|.*$", "", "\n".join(lines), flags=re.MULTILINE)):
                    self.assertLessEqual(len(sentence.split()), MOST_WORDS_OF_A_SENTENCE, sentence)
        for name, lines_of in (("claims", readme_tables.claims_lines), ("findings", readme_findings.lines_of),
                               ("methods", readme_findings.methods_lines)):
            _, stated, _ = readme_part.cut(SOURCE / "README.md", name)
            self.assertEqual(stated.strip().splitlines()[-len(lines := lines_of(judged)):], lines)


if __name__ == "__main__":
    unittest.main()
