"""`pbskin compare` names each number, row, table, run, study and verdict that differs. Reference: what each test
changes in a copy."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml

import program


class Compare(program.ProgramTest):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.results = scratch.name
        subprocess.run([program.PBSKIN, "reproduce", "audit", "momentum", "-o", cls.results, "--quiet"], check=True,
                       capture_output=True)

    def setUp(self):
        super().setUp()
        self.first, self.second = pathlib.Path(self.path("first")), pathlib.Path(self.path("second"))
        for folder in (self.first, self.second):
            shutil.copytree(self.results, folder)

    def differs(self, *words, part=()):
        """Exit status 1, and each of the words in what is printed."""
        said = self.ends(1, "compare", *part, self.first, self.second).stdout
        for word in words:
            self.assertIn(word, said)
        return said

    def add_table(self, *texts):
        """A further table of a run in each folder."""
        for folder, text in zip((self.first, self.second), texts):
            (folder / "audit" / "print" / "radii.csv").write_text(text)

    def change(self, table, change):
        """Applies a function to the rows of a table of the second folder, the head first."""
        file = self.second / table
        rows = list(csv.reader(file.open(newline="")))
        with file.open("w", newline="") as stream:
            csv.writer(stream, lineterminator="\n").writerows(change(rows))

    def test_equal_folders_agree(self):
        said = self.succeeds("compare", self.first, self.second).stdout
        self.assertRegex(said, r"^([1-9][\d,]*) of \1 numbers agree, \1 of them in every digit\.\n$")

    def test_a_number_that_differs_in_its_tenth_digit_is_named(self):
        def tenth_digit(rows):
            place = rows[0].index("printed")
            row = next(row for row in rows[1:] if row[place] not in ("0", "1"))
            row[place] = repr(float(row[place]) * (1 + 4e-9))
            return rows
        self.change("audit/print/printed.csv", tenth_digit)
        self.differs("other numbers, A | B (1):", "audit/print/printed.csv: ", ": printed = ")

    def test_a_row_that_is_missing_is_named(self):
        self.change("momentum/limb/measurements.csv", lambda rows: rows[:-1])
        self.differs(f"only in A = {self.first} (1):", "momentum/limb/measurements.csv: row ")
        self.succeeds("compare", "--part", self.first, self.second)
        self.first, self.second = self.second, self.first
        self.differs(f"only in B = {self.second} (1):", part=["--part"])  # a part has no row of its own

    def test_a_verdict_that_its_tables_do_not_give_is_named(self):
        def exchanged(rows):
            least, most = rows[0].index("least"), rows[0].index("most")
            return [rows[0], *([*row[:least], "-1e9", *row[least + 1:most], "1e9", *row[most + 1:]]
                               for row in rows[1:])]
        self.change("audit/print/printed.csv", exchanged)
        self.differs("other verdicts, A | B", "C14: inconsistent_in_print | holds")

    def test_a_run_a_study_and_a_table_that_are_missing_are_named(self):
        shutil.rmtree(self.second / "momentum" / "limb")
        (self.second / "audit" / "print" / "printed.csv").unlink()
        self.differs("  momentum/limb\n", "  audit/print/printed.csv\n")
        shutil.rmtree(self.second / "momentum")
        self.assertRegex(self.differs(), r"\n  momentum\n")

    def test_settings_that_differ_are_named_as_the_cause(self):
        one, other = (self.path(name) for name in ("one", "other"))
        run = ("run", "limb_twist", "--quiet", "--set", "motion.frames=3", "--set", 'deformers.use=["lbs","pbs"]',
               "--set", 'reference.name=""')
        self.succeeds(*run, "-o", one)
        self.succeeds(*run, "-o", other, "--set", "pbs.k_stretch=0.5")
        said = self.ends(1, "compare", one, other).stdout
        self.assertIn("pbs.k_stretch = 0.2 | 0.5\n", said)
        self.assertIn("other numbers, A | B", said)
        self.assertNotRegex(said, r"metrics\.csv: [^\n]*\blbs\b[^\n]*: volume_change_pct")  # LBS has no k_stretch

    def test_folders_without_results_are_refused(self):
        self.refuses("expected a folder of results", "compare", self.first, self.path("nothing"))
        pathlib.Path(self.path("empty")).mkdir()
        self.refuses("no results in this folder", "compare", self.path("empty"), self.first)

    def test_a_table_of_another_revision_is_named_by_its_columns(self):
        self.add_table("section,radius_m\nelbow,0.5\n", "section,largest_radius_m\nelbow,0.75\n")
        self.differs("audit/print/radii.csv: column radius_m", "audit/print/radii.csv: column largest_radius_m")

    def test_a_result_that_is_missing_in_a_part_is_named(self):
        self.add_table("section,radius_m\nelbow,0.5\nknee,0.75\n", "section,radius_m\nelbow,0.5\nknee,\n")
        self.differs("audit/print/radii.csv: knee: radius_m = 0.75 | \n", part=["--part"])
        # The second area is not measured.
        self.add_table("section,radius_m,area_m2\nelbow,0.5,1\n", "section,radius_m,area_m2\nelbow,0.5,\n")
        self.succeeds("compare", "--part", self.first, self.second)

    def test_a_text_among_numbers_is_a_number_that_differs(self):
        numbers = "".join(f"s{at},{at}.5\n" for at in range(1, 4))
        self.add_table("section,radius_m\n" + numbers, "section,radius_m\n" + numbers.replace("2.5", "n/a"))
        self.differs("audit/print/radii.csv: s2: radius_m = 2.5 | n/a")
        self.add_table("section,radius_m\ns0,n/a\n" + numbers,
                       "section,radius_m\ns0,n/a\n" + numbers.replace("3.5", "3.5000001"))
        self.differs("radius_m = 3.5 | 3.5000001")  # the tolerance is that of a column of numbers
        self.add_table("section,radius_m\nelbow,nan\n", "section,radius_m\nelbow,-nan\n")
        self.succeeds("compare", self.first, self.second)

    def test_what_a_spreadsheet_makes_of_a_table_is_named(self):
        good = "section,radius_m\nelbow,0.5\n"
        for text, words in (("\ufeff" + good, "byte order mark"), (good.replace(",", ";"), "separator is a semicolon"),
                            (good.replace("0.5", '"0,5"'), "expected a decimal point instead of a comma")):
            self.add_table(good, text)
            self.refuses(words, "compare", self.first, self.second)

    def test_what_was_not_compared_is_no_agreement(self):
        """Runs without a record in both folders, tables without a row, and frames that are cut off or missing."""
        runs = [pathlib.Path(self.path(side, "walk")) for side in "ab"]
        for run in runs:
            self.succeeds("run", "limb_twist", "--quiet", "-o", run, "--set", "motion.frames=2", "--set",
                          'deformers.use=["lbs"]', "--set", 'reference.name=""', "--set", "output.frames_every=1")
            shutil.copytree(run, run.parent / "killed")
        first, second = (run.parent for run in runs)
        self.succeeds("compare", first, second)
        for folder in (first, second):
            (folder / "killed" / "run.json").unlink()
        self.assertIn("killed: no run.json", self.ends(1, "compare", first, second).stdout)
        for folder in (first, second):
            shutil.rmtree(folder / "killed")
        frame = sorted(runs[1].glob("frames/*.vtu"))[0]
        whole = frame.read_bytes()
        at = 2 * len(whole) // 3
        changed = whole[:at] + bytes(byte ^ 21 for byte in whole[at:at + 40]) + whole[at + 40:]
        for damaged, words in ((whole[:len(whole) // 2], "the frame is cut off"), (changed, "VTK: ")):
            frame.write_bytes(damaged)
            self.assertIn(f"{frame.name}: {words}", self.ends(1, "compare", first, second).stdout)
        frame.unlink()
        self.assertIn(f"frames/{frame.name}", self.ends(1, "compare", first, second).stdout)
        frame.write_bytes(whole)
        for run in runs:
            table = run / "metrics.csv"
            table.write_text(table.read_text().splitlines(keepends=True)[0])
        self.assertIn("metrics.csv: that of A has no row", self.ends(1, "compare", first, second).stdout)
        shutil.copytree(runs[1], second / "more")
        self.assertIn("more", self.ends(1, "compare", "--part", first, second).stdout)
        self.refuses("expected another file than the input", "compare", first, second, "--json",
                     runs[0] / "metrics.csv")

    def test_runs_beside_the_plan_do_not_count(self):
        shutil.copytree(self.second / "momentum" / "limb", self.second / "momentum" / "stale")
        self.succeeds("compare", self.first, self.second)

    def test_folders_with_nothing_in_common_are_refused(self):
        run = self.path("run")
        self.succeeds("run", "limb_twist", "--quiet", "-o", run, "--set", "motion.frames=2", "--set",
                      'deformers.use=["lbs"]', "--set", 'reference.name=""')
        self.refuses("no number in common", "compare", "--part", self.first, run)

    def test_reports_for_programs(self):
        self.change("momentum/limb/measurements.csv", lambda rows: rows[:-1])
        files = self.path("differences.json"), self.path("differences.xml")
        self.ends(1, "compare", self.first, self.second, "--json", files[0], "--junit", files[1], "--quiet")
        found = json.loads(pathlib.Path(files[0]).read_text())
        self.assertFalse(found["agrees"])
        self.assertEqual((len(found["only_first"]), found["only_second"]), (1, []))
        suites = xml.parse(files[1]).getroot()
        self.assertEqual(suites.get("failures"), "1")
        self.assertTrue(re.search("row ", suites.find(".//testcase[failure]").get("name")))


class KeptRecord(program.ProgramTest):
    """The copy of the record that the program installs."""

    def setUp(self):
        super().setUp()
        self.records = pathlib.Path(self.path("records"))
        shutil.copytree(pathlib.Path(program.SOURCE) / "experiments" / "records" / "full", self.records,
                        ignore=shutil.ignore_patterns("claims.json", "report.html"))
        self.results = pathlib.Path(self.path("results"))

    def reproduces(self, *studies, status=0):
        records = os.environ | {"PBSKIN_RECORDS": str(self.records)}
        return self.ends(status, "reproduce", *studies, "-o", self.results, env=records).stdout

    def changed(self, table, old, new):
        file = self.records / table
        text = file.read_text()
        self.assertIn(old, text)
        file.write_text(text.replace(old, new, 1))

    def test_this_machine_repeats_it_and_names_the_nearest_method_within_the_time(self):
        """In this record the method that is nearest within 1 ms takes longer, so that the next one is named."""
        methods = self.records / "work_precision" / "methods.csv"
        rows = list(csv.DictReader(methods.read_text().splitlines()))
        known = [row for row in rows if row["table"] == "known" and float(row["budget_ms"]) == 1
                 and row["within"] != "no"]
        nearest, second = sorted(known, key=lambda row: float(row["share"]))[:2]
        nearest["within"] = "no"
        with methods.open("w", newline="") as stream:
            writer = csv.DictWriter(stream, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        said = self.reproduces("audit", "momentum")
        self.assertRegex(said, r"^This machine repeats the record: ([1-9][\d,]*) of \1 numbers agree")
        self.assertRegex(said, f"1 ms per frame: [^\n]* leaves {100 * float(second['share']):.0f} % of LBS's error if")

    def test_a_body_with_other_tets_is_named_once_and_its_runs_are_not_compared(self):
        references = pathlib.Path(self.path("references"))
        shutil.copytree(pathlib.Path(program.SOURCE) / "experiments" / "references", references)
        own, = (references / "tets").glob("limb-1775-*")
        other, = (references / "tets").glob("limb-1700-*")
        own.unlink()
        other.rename(other.with_name(other.name.replace("1700", "1775")))
        environment = os.environ | {"PBSKIN_RECORDS": str(self.records), "PBSKIN_REFERENCES": str(references)}
        done = self.ends(0, "reproduce", "momentum", "-o", self.results, env=environment)
        self.assertEqual(done.stderr.count("neither the runs of limb nor verdicts are compared with the record"), 1,
                         done.stderr)
        self.assertNotIn("runs of human", done.stderr)
        compared = json.loads((self.results / "repeated.json").read_text())
        self.assertTrue(compared["agrees"])
        self.assertNotIn("momentum/limb", json.dumps(compared))
        of_human = self.ends(1, "reproduce", "momentum", "--only", "human", "-o", self.path("of human"),
                             env=environment)
        self.assertNotIn("runs of limb", of_human.stderr)

    def test_a_folder_without_records_is_refused(self):
        records = os.environ | {"PBSKIN_RECORDS": self.path("nothing")}
        self.refuses("PBSKIN_RECORDS = ", "reproduce", "audit", "-o", self.results, env=records)

    def test_a_study_that_it_lacks_is_judged_by_the_results(self):
        shutil.rmtree(self.records / "audit")
        plans = self.records / "plans.json"
        plans.write_text(json.dumps({study: plan for study, plan in json.loads(plans.read_text()).items()
                                     if study != "audit"}))
        provenance = self.records / "provenance.json"
        origins = json.loads(provenance.read_text())["origins"]
        kept = [origin | {"runs": [run for run in origin["runs"] if not run.startswith("audit/")]}
                for origin in origins]
        provenance.write_text(json.dumps({"origins": kept}))
        self.assertIn("C14 ", self.succeeds("reproduce", "audit", "-o", self.results,
                                            env=os.environ | {"PBSKIN_RECORDS": str(self.records)}).stdout)

    def test_a_changed_number_a_missing_row_and_another_verdict_are_named(self):
        momentum, printed = "momentum/runs/measurements.csv", "audit/runs/printed.csv"
        row = (self.records / momentum).read_text().splitlines(keepends=True)[1]
        for named, (table, old, new) in {
                "momentum/": (momentum, row, ""),
                ": printed = ": (printed, ",2000,", ",2000.000008,"),
                "C14: ": ("claims.md", "| inconsistent_in_print |", "| holds |")}.items():
            with self.subTest(named):
                kept = (self.records / table).read_text()
                self.changed(table, old, new)
                said = self.reproduces("momentum" if table == momentum else "audit", status=1)
                self.assertIn("does NOT repeat the record", said)
                self.assertIn(named, said)
                if table == printed:  # one number
                    claims = json.loads((self.results / "repeated.json").read_text())["claims"].values()
                    self.assertEqual(sum(claim["compared"] - claim["agree"] for claim in claims), 1)
                (self.records / table).write_text(kept)


if __name__ == "__main__":
    unittest.main()
