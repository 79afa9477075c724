"""The verdicts in the README equal those of the kept records by the bounds of claims.toml: they change only with new records or another
rule."""
import pathlib
import shutil
import sys
import unittest

import program

SOURCE = pathlib.Path(program.SOURCE)
KEPT = SOURCE / "experiments" / "records" / "full"
sys.path.insert(0, str(SOURCE / "paper_figures"))
from readme import findings as readme_findings, part as readme_part, tables as readme_tables  # noqa: E402
from records import kept  # noqa: E402
from words import sentences  # noqa: E402


class KeptVerdicts(program.ProgramTest):
    def judged(self):
        copy = pathlib.Path(self.path("kept"))
        shutil.copytree(KEPT, copy)
        (copy / "claims.md").unlink()
        self.succeeds("reproduce", "--judge", "-o", copy, "--quiet")
        return copy

    def test_records_beside_the_sources_give_the_verdicts_on_record(self):
        self.assertEqual((self.judged() / "claims.md").read_text(), (KEPT / "claims.md").read_text())

    def test_all_seventeen_claims_are_on_record(self):
        claims = sentences.claims_of(self.judged() / "claims.json")
        self.assertEqual([claim["id"] for claim in claims], [f"C{number:02d}" for number in range(1, 18)])

    def test_judging_them_where_they_lie_leaves_nothing_that_git_would_see(self):
        ignored = (SOURCE / ".gitignore").read_text().splitlines()
        before, after = ({file.relative_to(folder) for file in folder.rglob("*")} for folder in (KEPT, self.judged()))
        for file in after - before:
            self.assertIn(f"/experiments/records/full/{file}", ignored)

    def test_readme_states_each_claim_and_finding_as_the_records_have_it(self):
        judged = kept.opened(self.judged())
        for name, lines_of in (("claims", readme_tables.claims_table), ("findings", readme_findings.lines_of)):
            _, stated, _ = readme_part.cut(SOURCE / "README.md", name)
            self.assertEqual(stated.strip().split("\n\n")[0].splitlines(), lines_of(judged))


if __name__ == "__main__":
    unittest.main()
