"""The report refuses records of another shape with file, field, value and rule, exit status 2 and no page. Reference: the contract in
README. Every value of small records takes every other kind in turn, and no result is a traceback."""
import json
import pathlib
import tomllib
import unittest
import unittest.mock

from results_case import ReportTest
import records
import synthetic_records
from records import shapes as record_shapes

RUN, POSE, PLAN, CLAIMS = "volume/limb_twist/run.json", "work_precision/twist/run.json", "volume/plan.json", "claims.json"
ANYTHING = (None, True, 3, -1e300, "x", "", [], [3], ["x"], {}, {"x": 3})

REFUSED = tomllib.loads(pathlib.Path(__file__).with_name("refused_records.toml").read_text())["rows"]


def parts(value, place=()):
    """Each place in a record; in a list the first and the last."""
    yield place
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from parts(inner, (*place, key))
    elif isinstance(value, list):
        for at in sorted({0, len(value) - 1} if value else ()):
            yield from parts(value[at], (*place, at))


def changed(record, place, value):
    if not place:
        return value
    record = json.loads(json.dumps(record))
    inner = record
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    return record


class ReportRecords(ReportTest):
    def setUp(self):
        super().setUp()
        synthetic_records.write_study(self.results)
        synthetic_records.write_claims(self.results)
        synthetic_records.write_poses(self.results)
        run = {**json.loads((self.results / RUN).read_text()), "outcome": {"frames": 37, "frames_with_overlap": 0},
               "scene": {"reference": {"name": "snh"}, "fem": [{"name": "snh", "model": "stable_neo_hookean", "element_order": 1}]},
               "work": {"settings": {}}}
        run["provenance"] |= {"libraries": {"Eigen": "3.4.0"}, "input_hashes": {"limb": "0123"}, "threads": 1}
        self.put(RUN, run)
        self.put(PLAN, {"extent": "quick", "runs": [{"name": "limb_twist"}], "left_out": [{"scene": "walk", "reason": "no clip"}]})

    def put(self, name, record):
        (self.results / name).write_text(json.dumps(record))

    def record(self, name):
        return json.loads((self.results / name).read_text())

    def made(self):
        """Exit status, error messages, whether there is a page."""
        status, text, _, complaints = self.report()
        return status, complaints, text != ""

    def test_what_the_cases_are_made_of_is_accepted(self):
        self.assertEqual(self.made(), (0, "", True))

    def test_a_value_of_another_kind_is_refused_by_file_field_value_and_rule(self):
        self.assertEqual(len(REFUSED), 40)
        for name, place, value, words in REFUSED:
            with self.subTest(f"{name} {place} {value[:40]}"):
                whole, keys = self.record(name), [int(key) if key.isdigit() else key for key in place.split(".") if key]
                self.put(name, changed(whole, keys, json.loads(value.replace("ZEROS", 400 * "0"))))
                status, said, there = self.made()
                self.put(name, whole)
                self.assertEqual((status, there), (2, False))
                self.assertIn(f"pbskin: {self.results / name}: {words}", said)

    def test_no_value_of_any_kind_ends_in_a_traceback(self):
        for name in (RUN, POSE, PLAN, CLAIMS):
            whole = self.record(name)
            for place in parts(whole):
                for value in ANYTHING:
                    with self.subTest(f"{name} {place} {value}"):
                        self.put(name, changed(whole, place, value))
                        status, said, there = self.made()
                        self.assertEqual((status, there), (2, False) if said else (0, True))
                        self.assertTrue(not said or f"pbskin: {self.results / name}: " in said, said)
            self.put(name, whole)

    def test_numbers_without_an_end_and_text_without_one_are_no_json(self):
        for content in ("9" * 5000, "[" * 100000, '{"scene": NaN'):
            (self.results / RUN).write_text(content)
            status, said, there = self.made()
            self.assertEqual((status, there), (2, False))
            self.assertIn("not JSON", said)

    def test_a_run_against_a_reference_without_its_outcome_is_named_in_the_page(self):
        run = self.record(RUN)
        del run["outcome"]
        self.put(RUN, run)
        self.assertIn("volume/limb_twist/run.json: outcome: missing", self.report()[2])

    def test_cells_of_tables_are_refused_alike(self):
        points = self.results / "work_precision/twist/points.csv"
        whole = points.read_text()
        points.write_text(whole.replace("50.0", "east"))
        status, said, there = self.made()
        self.assertEqual((status, there), (2, False))
        self.assertIn(f"pbskin: {points}:2: error_joint_pct = east: expected a number", said)
        points.write_text(whole.replace("motion", "movement", 1))
        self.assertIn(f"pbskin: {points}:2: no column motion", self.made()[1])


class RecordShapes(unittest.TestCase):
    def test_what_is_not_named_is_not_looked_at(self):
        record_shapes.check("a.json", {"a": 1, "b": object()}, {"a": record_shapes.number, "c?": record_shapes.text})

    def test_a_number_is_one_that_can_be_shown(self):
        for value in (0, -1.5, 10 ** 300):
            record_shapes.check("a.json", value, record_shapes.number)
        for value in (True, float("nan"), float("inf"), 10 ** 400, "1", None):
            with self.subTest(value), self.assertRaisesRegex(records.RecordsMissing, "^a.json: .*: expected a number$"):
                record_shapes.check("a.json", value, record_shapes.number)


if __name__ == "__main__":
    unittest.main()
