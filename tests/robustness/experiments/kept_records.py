"""The kept part of a study's records is sufficient to judge its claims again, and is kept as a whole or not at all.
Reference: the verdicts from the complete records."""
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import unittest

import program

KEEP = pathlib.Path(program.SOURCE) / "experiments" / "records" / "keep.py"
sys.path.insert(0, str(KEEP.parent))
import keep  # noqa: E402
sys.path.insert(0, str(pathlib.Path(program.SOURCE) / "paper_figures"))
from records import RecordsMissing, kept as kept_records  # noqa: E402


class KeptRecords(program.ProgramTest):
    def recorded(self, *studies):
        """The folder of their records, and that of the kept ones."""
        results, kept = pathlib.Path(self.path("results")), pathlib.Path(self.path("kept"))
        self.succeeds("reproduce", *studies, "-o", results, "--quiet")
        return results, kept

    def keep(self, results, kept):
        return subprocess.run([sys.executable, "-B", str(KEEP), str(results), str(kept)], capture_output=True,
                              text=True)

    def test_numbers_have_six_digits_and_names_stay(self):
        for cell, kept in (("0.1234567", "0.123457"), ("-1.5E-07", "-1.5e-07"), (".5", "0.5"), ("12345678", "12345678"),
                           ("-3", "-3"), ("01_01", "01_01"), ("1_000", "1_000"), ("nan", "nan"),
                           ("upper|forearm", "upper|forearm"), ("", "")):
            self.assertEqual(keep.rounded(cell), kept)

    def test_verdicts_come_back(self):
        results, kept = self.recorded("audit", "momentum")
        told = json.loads((results / "claims.json").read_text())
        self.assertEqual(self.keep(results, kept).returncode, 0)
        self.succeeds("reproduce", "--judge", "-o", kept, "--quiet")
        self.assertEqual(json.loads((kept / "claims.json").read_text()), told)
        provenance = kept / "provenance.json"
        provenance.write_text(provenance.read_text().replace('"momentum/limb"', '"momentum/another"'))
        self.ends(1, "reproduce", "--judge", "-o", kept, "--quiet")

    def test_studies_without_new_records_keep_their_earlier_ones(self):
        results, kept = self.recorded("audit")[0], self.kept_records(study="study")
        before = (kept / "study" / "runs" / "metrics.csv").read_text()
        self.assertEqual(self.keep(results, kept).returncode, 0)
        self.assertEqual((kept / "study" / "runs" / "metrics.csv").read_text(), before)
        self.assertEqual(set(json.loads((kept / "plans.json").read_text())), {"audit", "study"})
        origins = json.loads((kept / "provenance.json").read_text())["origins"]
        self.assertEqual([origin["runs"] for origin in origins], [["audit/print"], ["study/one"]])

    def test_each_run_has_its_tables_again(self):
        results, merged, opened = (pathlib.Path(self.path(name)) for name in ("results", "merged", "opened"))
        tables = {"study/one/a.csv": "x,y\n1,\"p,q\"\n2,r\n", "study/two/a.csv": "y,z\ns,3\n",
                  "study/two/b.csv": "only\n", "study/a.csv": "sum\n6\n", "study/costs.csv": "run,cpu_s\none,1\n"}
        runs = {f"study/{run}/run.json": json.dumps({"schema": 3, "provenance": {"version": version}})
                for run, version in (("one", "1"), ("two", "2"))}
        for name, text in (tables | runs | {"study/plan.json": '{"runs": []}'}).items():
            (results / name).parent.mkdir(parents=True, exist_ok=True)
            (results / name).write_text(text)
        keep.merge(results, merged, [])
        kept_records.expand(merged, opened)
        columns_of_both = {"study/one/a.csv": "x,y,z\n1,\"p,q\",\n2,r,\n", "study/two/a.csv": "x,y,z\n,s,3\n"}
        for name, text in (tables | columns_of_both).items():
            self.assertEqual((opened / name).read_text(), text)
        for name, text in runs.items():
            self.assertEqual(json.loads((opened / name).read_text()), json.loads(text))
        self.assertEqual(sorted(file.name for file in (merged / "study" / "runs").iterdir()), ["a.csv", "b.csv"])

    def test_a_long_table_is_compressed(self):
        results, kept = self.recorded("audit")
        # Few long rows, since reading many short ones takes longer.
        rows = "".join(f"{number:0999}\n" for number in range(keep.COMPRESSED_FROM // 1000 + 1))
        (results / "audit" / "print" / "rates.csv").write_text("number\n" + rows)
        told = json.loads((results / "claims.json").read_text())
        self.assertEqual(self.keep(results, kept).returncode, 0)
        self.assertFalse((kept / "audit" / "runs" / "rates.csv").exists())
        self.assertEqual((kept_records.opened(kept) / "audit" / "print" / "rates.csv").read_text(), "number\n" + rows)
        self.succeeds("reproduce", "--judge", "-o", kept, "--quiet")
        self.assertEqual(json.loads((kept / "claims.json").read_text()), told)
        self.succeeds("compare", results, kept, "--quiet")
        compressed = kept / "audit" / "runs" / "rates.csv.gz"
        compressed.write_bytes(compressed.read_bytes()[:1000])
        self.refuses("expected a whole gzip file", "reproduce", "--judge", "-o", kept, "--quiet")

    def test_every_column_of_another_table_is_kept(self):
        table = "change,setting,iterations\nbound,0.002,4\nbound,0.01,4\n"
        keep.keep_table(pathlib.Path(self.write("table.csv", table)), pathlib.Path(self.path("kept.csv")))
        self.assertEqual(self.read("kept.csv"), table)

    def kept_records(self, table="run,x\none,1\n", study="study", **origin):
        """The folder of kept records of one run, which may be changed."""
        os.makedirs(self.path("kept", "study", "runs"), exist_ok=True)
        origins = [{"schema": 3, "provenance": {"version": "1"}, "runs": ["study/one"]} | origin]
        self.write("kept/plans.json", json.dumps({study: {"runs": [{"name": "one"}]}}))
        self.write("kept/provenance.json", json.dumps({"origins": origins}))
        self.write("kept/study/runs/metrics.csv", table)
        return pathlib.Path(self.path("kept"))

    def test_names_that_leave_the_folder_are_refused(self):
        message = "expected no leading / and no .. in a name"
        for name in ("../outside", self.path("outside"), "one/../../../outside"):
            for changed in ({"study": name}, {"runs": [name]}, {"table": f"run,x\n{name},1\n"}):
                with self.subTest(changed), self.assertRaisesRegex(RecordsMissing, message):
                    kept_records.opened(self.kept_records(**changed))
                self.refuses(message, "reproduce", "--judge", "-o", self.path("kept"), "--quiet")
        self.assertFalse(os.path.exists(self.path("outside")))

    def test_malformed_tables_and_origins_are_refused(self):
        for message, changed in (("metrics.csv:2: one: expected a name and the cells of a row",
                                  {"table": "run,x\none\n"}),
                                 ("metrics.csv:2: : expected a name", {"table": "run,x\n,1\n"}),
                                 ("metrics.csv: no rows", {"table": ""}), ("provenance.json: not as", {"runs": 1})):
            with self.subTest(changed), self.assertRaisesRegex(RecordsMissing, message):
                kept_records.opened(self.kept_records(**changed))

    def test_files_that_are_not_kept_are_listed(self):
        results, kept = self.recorded("audit")
        long = "number\n" + "1\n" * 40_000
        # The last two are listed whatever their length.
        for name, text in (("lengths", long), ("rates", long), ("profiles", "x\n1\n")):
            (results / "audit" / "print" / f"{name}.csv").write_text(text)
        self.assertEqual(self.keep(results, kept).returncode, 0)
        rows = ["study,run,file,bytes", f"audit,print,lengths.csv,{len(long)}", "audit,print,profiles.csv,4"]
        self.assertEqual((kept / "not_kept.csv").read_text().splitlines(), rows)
        self.assertFalse((kept / "audit" / "runs" / "lengths.csv").exists())
        self.assertEqual((kept / "audit" / "runs" / "rates.csv").read_text(),
                         long.replace("number", "run,number").replace("1", "print,1"))

    @staticmethod
    def noise(letters):
        """Text that cannot be compressed to less than half."""
        return re.sub("(.{99}).", r"\1\n", random.Random(1).randbytes(letters // 2).hex()) + "\n"

    def test_what_cannot_be_kept_leaves_the_last_records_alone(self):
        results, kept = self.recorded("audit")
        self.assertEqual(self.keep(results, kept).returncode, 0)
        before = {file: file.read_bytes() for file in kept.rglob("*.*") if file.is_file()}
        (results / "audit" / "print" / "measurements.csv").write_text("claim\n" + self.noise(20_000_000))
        self.assertIn("more than 8", self.keep(results, kept).stderr)
        self.assertIn("no records", self.keep(pathlib.Path(self.path("nothing")), kept).stderr)
        self.assertEqual({file: file.read_bytes() for file in kept.rglob("*.*") if file.is_file()}, before)


if __name__ == "__main__":
    unittest.main()
