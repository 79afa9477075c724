"""Figures are complete or do not exist, every figure is listed with the records that it needs, and none is drawn from
records that are missing or do not belong together. Reference: the definition, and the contents of the folder after each
way in which drawing can end."""
import importlib
import inspect
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tomllib
import unittest
from unittest import mock

from results_case import FORMATS, ResultsTest, root
import synthetic_records
from records import entries, whole_file
from words import captions


class Listing(ResultsTest):
    def test_every_entry_tells_what_to_see_and_has_a_script_that_draws(self):
        claims = {claim["id"]
                  for claim in tomllib.loads((root / "experiments" / "verdicts" / "claims.toml").read_text())["claim"]}
        for entry in entries.read():
            with self.subTest(entry.name):
                self.assertIn(entry.mark, entries.marks)
                self.assertGreater(len(entry.caption.split()), 8)
                self.assertTrue(entry.title and entry.records)
                self.assertLessEqual(set(entry.claims), claims)
                module = importlib.import_module(f"figures.{entry.script}")
                self.assertEqual(list(inspect.signature(getattr(module, entry.name)).parameters), ["results"])
                self.assertTrue(module.__doc__)
                if captions.asked(entry) - captions.of_runs:
                    self.assertTrue(callable(getattr(module, f"{entry.name}_facts", None)))

    def test_every_function_that_draws_a_figure_is_listed(self):
        defined = {(file.stem, name) for file in (root / "paper_figures" / "figures").glob("*.py")
                   for name in re.findall(r"^def (\w+)\(results\):", file.read_text(), re.MULTILINE)}
        self.assertEqual(defined, {(entry.script, entry.name) for entry in entries.read()})

    def test_without_its_records_every_figure_refuses_with_the_reason(self):
        for entry in entries.read():
            for study in entry.studies():
                synthetic_records.write_origin(self.results / study / "run")
        said = self.make_all(status=1)[1]
        for entry in entries.read():
            cause = (self.results / "figures" / f"{entry.name}.cause.txt").read_text().strip()
            self.assertRegex(cause, f"^{self.results}.*: does not exist$")
            named, = [line for line in said.splitlines() if line.endswith(f" not drawn: {cause}")]
            self.assertIn(entry.name, re.findall(r"\w+", named))
        self.assertEqual({file.name for file in self.results.glob("figures/*")},
                         {f"{entry.name}.cause.txt" for entry in entries.read()})

    def test_one_cause_of_several_figures_is_printed_once(self):
        synthetic_records.write_study(self.results)
        without = mock.Mock(side_effect=ValueError)
        with mock.patch("matplotlib.font_manager.findfont", without):
            said = self.make_all(status=1)[1]
        about_font = [line for line in said.splitlines() if "fonts-dejavu-core" in line]
        self.assertEqual(len(about_font), 1, said)
        self.assertIn("volume_over_angle", about_font[0])
        self.make_all("volume_over_angle", formats=FORMATS)
        self.assertFalse((self.results / "figures" / "volume_over_angle.cause.txt").exists())


def quick_studies():
    """The studies that ./reproduce runs without --full, from the definitions of the studies that study.hpp declares,
    and the sets there."""
    folder = root / "experiments" / "studies"
    header = (folder / "study.hpp").read_text()
    not_quick = set(re.findall(r"constexpr Sets (\w+) = \{Extent::none", header))
    entry = re.compile(r'^Study \w+_study\(\)\n\{\n\s+return \{"(\w+)",?([^;]*)\};', re.MULTILINE)
    found = [match for source in folder.rglob("*.cpp") for match in entry.findall(source.read_text())]
    declared = re.findall(r"^Study (\w+)_study\(\);", header, re.MULTILINE)
    if sorted(declared) != sorted(name for name, _ in found):
        raise AssertionError(f"declared {sorted(declared)}, but entries of the expected form are "
                             f"{sorted(name for name, _ in found)}")
    return {name for name, rest in found if not not_quick & set(re.findall(r"\w+", rest))}


class Marks(unittest.TestCase):
    def test_what_is_marked_r_needs_studies_of_the_quick_set_alone_and_nothing_else_does(self):
        quick = quick_studies()
        self.assertLess({"volume", "frames", "timing", "work_precision"}, quick)
        self.assertNotIn("verification", quick)
        for entry in entries.read():
            with self.subTest(entry.name):
                of_full_form = any(re.match("timing/(bench/|features_)", of) for of in entry.records)
            self.assertEqual(entry.mark, "R" if quick.issuperset(entry.studies()) and not of_full_form else "CR")


class Planned(ResultsTest):
    """Runs that a plan names and that have no records."""
    def setUp(self):
        super().setUp()
        synthetic_records.write_work_precision(self.results)
        self.entry = {entry.name: entry for entry in entries.read()}

    def plan(self, *names, study="work_precision"):
        (self.results / study / "plan.json").write_text(json.dumps({"runs": [{"name": name} for name in names]}))

    def test_without_a_plan_and_with_all_on_record_nothing_is_absent(self):
        self.assertEqual(self.entry["error_against_time"].absent(self.results), ([], 3))
        self.assertEqual(self.make_all("error_against_time", formats=FORMATS)[1], "")
        self.assertNotIn("without records", (self.results / "figures" / "error_against_time.caption.txt").read_text())
        (self.results / "work_precision" / "plan.json").unlink()
        self.assertEqual(self.entry["error_against_time"].absent(self.results), ([], 0))

    def test_what_is_not_on_record_stands_in_the_caption(self):
        self.plan("limb", "human", "played_01_01", "man", "lady")
        self.assertEqual(self.make_all("error_against_time", formats=FORMATS)[1], "")
        self.assertTrue((self.results / "figures" / "error_against_time.caption.txt").read_text()
                        .endswith(" Planned runs without records, 2 of 5: man, lady.\n"))

    def test_of_a_pattern_those_that_it_matches(self):
        synthetic_records.write_jiggle(self.results / "jiggle")
        self.plan("limb_jolt", "limb_reference", "human_jolt", "human_walk", study="jiggle")
        self.assertEqual(self.entry["jiggle_response"].absent(self.results), (["human_jolt"], 2))

    def test_a_table_of_the_study_sums_up_all_runs(self):
        synthetic_records.write_timing_of_sizes(self.results / "timing")
        self.plan("man_1654", "lady_1829", study="timing")
        self.assertEqual(self.entry["timing_sizes"].absent(self.results), (["lady_1829"], 2))
        self.assertEqual(self.entry["section_profiles"].absent(self.results), ([], 0))


class Staleness(ResultsTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)
        self.volume = self.results / "volume"

    def assert_stale(self, reason, name="volume_over_angle"):
        said = self.make_all(name, status=1)[1]
        self.assertIn(f"{name} not drawn: stale: ", said)
        self.assertIn(reason, said)
        self.assertFalse((self.results / "figures" / f"{name}.png").exists())

    def test_a_figure_that_is_refused_leaves_no_old_one(self):
        self.make_all("volume_over_angle")
        self.refused_without("volume/limb_bend/metrics.csv", "volume_over_angle")
        self.assertEqual([file.name for file in self.results.glob("figures/volume_over_angle.*")],
                         ["volume_over_angle.cause.txt"])

    def test_two_revisions_in_one_figure(self):
        synthetic_records.write_origin(self.volume / "limb_bend", of="f" * 40)
        self.assert_stale(f"of revision 0123456789, {self.volume / 'limb_bend'} of ffffffffff")
        self.make_all("volume_over_clip", formats=FORMATS)  # all runs have one revision

    def test_a_dirty_tree_is_another_revision(self):
        run = self.volume / "limb_bend" / "run.json"
        record = json.loads(run.read_text())
        record["provenance"]["git_dirty"] = True
        run.write_text(json.dumps(record))
        self.assert_stale(f"{self.volume / 'limb_bend'} of 0123456789 (dirty)")

    def test_a_run_that_its_plan_does_not_name(self):
        (self.volume / "plan.json").write_text(json.dumps({"runs": [{"name": "limb_twist"}]}))
        self.assert_stale("limb_bend is no run of its study's plan.json")

    def test_a_table_changed_after_its_run(self):
        table, ended_s = self.volume / "limb_twist" / "metrics.csv", (self.volume / "limb_twist"
                                                                      / "run.json").stat().st_mtime
        os.utime(table, (ended_s + 30, ended_s + 30))
        self.make_all("volume_over_angle")
        os.utime(table, (ended_s + 90, ended_s + 90))
        self.assert_stale("metrics.csv was changed after its run ended")

    def test_a_table_older_than_a_run_that_it_sums_up(self):
        table, ended_s = self.volume / "regions.csv", (self.volume / "limb_twist" / "run.json").stat().st_mtime
        os.utime(table, (ended_s - 90, ended_s - 90))
        self.assert_stale("regions.csv is older than", "volume_by_region")


class WholeFile(ResultsTest):
    def setUp(self):
        super().setUp()
        self.file = self.results / "volume.png"
        self.file.write_text("old")

    def names(self):
        return sorted(path.name for path in self.results.iterdir())

    def drawn_elsewhere(self, lines):
        """How a separate process that draws has ended."""
        text = (f"import os, pathlib, signal, whole_file\nwith whole_file.beside(pathlib.Path({str(self.file)!r})) as "
                f"path:\n{lines}")
        paths = {**os.environ, "PYTHONPATH": str(pathlib.Path(whole_file.__file__).parent)}
        return subprocess.run([sys.executable, "-B", "-c", text], env=paths, capture_output=True).returncode

    def test_a_failure_leaves_the_old_one(self):
        with self.assertRaises(KeyError), whole_file.beside(self.file) as path:
            path.write_text("half")
            raise KeyError
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_a_kill_leaves_the_old_one_and_the_next_drawing_removes_the_half(self):
        killed = self.drawn_elsewhere(" path.write_text('half'); os.kill(os.getpid(), signal.SIGKILL)")
        self.assertEqual(killed, -signal.SIGKILL)
        self.assertEqual(self.file.read_text(), "old")
        self.assertEqual(len(self.names()), 2)
        with whole_file.beside(self.file) as path:
            self.assertEqual(path.suffix, ".png")
            path.write_text("new")
            self.assertEqual(self.file.read_text(), "old")
        self.assertEqual((self.file.read_text(), self.names()), ("new", ["volume.png"]))

    def test_a_full_disk_names_the_file_and_the_reason(self):
        usual = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, usual[1]))  # Python ignores SIGXFSZ, so write() fails
        self.addCleanup(resource.setrlimit, resource.RLIMIT_FSIZE, usual)
        with self.assertRaisesRegex(whole_file.CannotBeWritten,
                                    "volume.png: cannot be written: "
                                    "File too large"), whole_file.beside(self.file) as path:
            path.write_bytes(bytes(5000))
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_a_reason_that_is_not_the_systems_is_told_in_its_own_words(self):
        # The words of the image library.
        expected = "volume.png: cannot be written: encoder error -2 when writing image file"
        with self.assertRaisesRegex(whole_file.CannotBeWritten, expected), whole_file.beside(self.file):
            raise OSError("encoder error -2 when writing image file")

    def test_what_the_block_cannot_read_is_not_called_unwritable(self):
        with self.assertRaises(FileNotFoundError), whole_file.beside(self.file):
            (self.results / "elsewhere" / "records.csv").read_text()
        self.assertEqual((self.file.read_text(), self.names()), ("old", ["volume.png"]))

    def test_the_folder_is_made_or_why_it_cannot_be_is_told(self):
        with whole_file.beside(self.results / "figures" / "new" / "a.png") as path:
            path.write_text("new")
        self.assertEqual((self.results / "figures" / "new" / "a.png").read_text(), "new")
        for below in ("volume.png/a.png", "volume.png/figures/a.png"):  # a file where the folder would be
            with self.subTest(below), self.assertRaisesRegex(whole_file.CannotBeWritten, "a.png: cannot be written: "):
                with whole_file.beside(self.results / below) as path:
                    path.write_text("new")


if __name__ == "__main__":
    unittest.main()
