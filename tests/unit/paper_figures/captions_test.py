"""Captions agree with the rows behind their figure, and contain no number that another run would change. Reference:
captions.toml and the rows."""
import dataclasses
import re
import tomllib
import unittest

from results_case import ResultsTest, root
import make_all
import synthetic_records
from records import entries
from synthetic_records import write_table
from words import captions


listed = {entry.name: entry for entry in entries.read()}
# A quick run has fewer settings.
extents_differ = {"convergence", "jiggle", "stability", "stiffness", "volume", "work_precision"}
same_in_every_run = {"0.5 %", "8 frames in 10", "24 iterations", "after 24", "90 degrees", "2007", "4.5e15 N/m", "1 N",
                     "1 m", "01_01", "95 %"}


class Captions(ResultsTest):
    def title_and_caption(self, name, rows):
        write_table(self.results / f"{name}.csv", rows)
        return " ".join(captions.whole(listed[name], self.results, {"cpu_model": "a processor"}, part)
                        for part in ("title", "caption"))

    def test_each_states_the_facts_of_the_rows_behind_its_figure(self):
        for case in tomllib.loads((root / "tests/unit/paper_figures/captions.toml").read_text(encoding="utf-8"))[
            "case"]:
            text = self.title_and_caption(case["figure"], [dict(zip(case["columns"], row)) for row in case["rows"]])
            for words in case["states"]:
                with self.subTest(case["what"]):
                    self.assertIn(words, text)

    def test_no_number_that_another_run_would_change_is_typed(self):
        for entry in listed.values():
            if extents_differ & set(entry.studies()):
                rest = re.sub(r"\{\w+\}", "", f"{entry.title} {entry.caption}")
                for words in same_in_every_run:
                    rest = rest.replace(words, "")
                self.assertEqual(re.findall(r"\d[\d.,]*", rest), [], entry.name)

    def test_figures_of_time_name_the_processor(self):
        timed = [entry for entry in listed.values() if set(entry.studies()) & {"timing", "work_precision"}]
        self.assertEqual(len(timed), 6)
        for entry in timed:
            with self.subTest(entry.name):
                write_table(self.results / f"{entry.name}.csv", [
                    {"shown": "answer", "text": "", "target_pct": 35, "budget_ms": 1, "method": "pbs", "solved_pct": 50,
                     "poses": 40}])
                self.assertIn("{cpu}", entry.caption)
                self.assertIn("a processor", captions.whole(entry, self.results, {"cpu_model": "a processor"}))
                self.assertIn("a processor that is not on record", captions.whole(entry, self.results, {}))

    def test_it_is_written_with_the_figure_and_deleted_with_it(self):
        synthetic_records.write_study(self.results)
        self.make_all("volume_over_iterations")
        file = self.results / "figures" / "volume_over_iterations.caption.txt"
        text = file.read_text()
        self.assertIn("the signed change is \u22122 % for the human's median and \u22120.00375 % for the limb bent by "
                      "90 degrees; after 96 iterations it is \u22122 %", text)
        self.assertEqual(captions.read(listed["volume_over_iterations"], file.parent), text.rstrip("\n"))
        make_all.delete("volume_over_iterations", file.parent)
        self.assertFalse(file.exists())
        with self.refused("volume_over_iterations.caption.txt: does not exist"):
            captions.read(listed["volume_over_iterations"], file.parent)

    def test_a_number_that_no_script_tells_is_an_error(self):
        self.title_and_caption("stability_maps",
                               [{"map": "map_time_step_k_stretch.csv", "outcome": "bounded", "steps": 1}])
        with self.assertRaises(KeyError):
            captions.whole(dataclasses.replace(listed["stability_maps"], caption="see {nothing}"), self.results, {})


if __name__ == "__main__":
    unittest.main()
