"""The decisions of the studies ensemble and work_precision follow from the tables of the kept records, and the settings that ensemble takes
from the training poses are those of settings.csv. Reference: the rule |e_A^2 - e_B^2| > 2 |A - B| U of analysis/verdicts/pair_order.hpp."""
import collections
import csv
import math
import pathlib
import re
import sys
import tomllib
import unittest

import program

SOURCE = pathlib.Path(program.SOURCE)
sys.path.insert(0, str(SOURCE / "paper_figures"))
from records import kept  # noqa: E402

KEPT = kept.opened(SOURCE / "experiments" / "records" / "full")


def rows(study, pattern):
    """Of all tables that match."""
    files = sorted((KEPT / study).glob(pattern))
    if not files:
        raise unittest.SkipTest(f"the kept records have no {study}/{pattern}")
    return [row for file in files for row in csv.DictReader(file.read_text(encoding="utf-8").splitlines())]


def order(row):
    """How one reference orders the pair. The sum of the errors stands for a distance that is not known."""
    if not all(row[name] for name in ("first_error_pct", "second_error_pct", "error_bound_pct")):
        return "undecided"
    first, second, bound = (float(row[name]) for name in ("first_error_pct", "second_error_pct", "error_bound_pct"))
    apart = float(row["distance_pct"]) if row["distance_pct"] else first + second
    if abs(first ** 2 - second ** 2) <= 2.0 * apart * bound:
        return "undecided"
    return "first_is_closer" if first < second else "second_is_closer"


def decision(orders):
    orders = set(orders)
    if {"first_is_closer", "second_is_closer"} <= orders:
        return "models_disagree"
    return "reference_error" if "undecided" in orders else "decided"


def by(table, *names):
    groups = collections.defaultdict(list)
    for row in table:
        groups[tuple(row[name] for name in names)].append(row)
    return groups


class Rule(unittest.TestCase):
    def test_needs_a_gap_of_the_squares_and_all_references(self):
        row = {"first_error_pct": "3", "second_error_pct": "5", "distance_pct": "2.5", "error_bound_pct": "3.1"}
        self.assertEqual(order(row), "first_is_closer")  # 25 - 9 > 2 x 2.5 x 3.1
        self.assertEqual(order(row | {"error_bound_pct": "3.3"}), "undecided")
        self.assertEqual(order(row | {"distance_pct": ""}), "undecided")  # 16 < 2 x 8 x 3.1
        self.assertEqual(order(row | {"error_bound_pct": ""}), "undecided")
        self.assertEqual(order(row | {"second_error_pct": "0.1", "error_bound_pct": "1"}), "second_is_closer")
        self.assertEqual(decision(["first_is_closer"] * 2), "decided")
        self.assertEqual(decision(["first_is_closer", "undecided"]), "reference_error")
        self.assertEqual(decision(["first_is_closer", "undecided", "second_is_closer"]), "models_disagree")


class Decisions(unittest.TestCase):
    def test_of_pairs_follow_from_the_orders_of_all_references_in_both_settings(self):
        names = ("body", "motion", "pose", "angle_deg", "first", "second")
        orders = by(rows("ensemble", "*/pair_orders.csv"), *names)
        pairs = by(rows("ensemble", "pairs.csv"), *names)
        self.assertEqual(set(orders), set(pairs))
        for pair, (row,) in pairs.items():
            with self.subTest(pair):
                self.assertEqual([one["order"] for one in orders[pair]], [order(one) for one in orders[pair]])
                self.assertEqual(row["decision"], decision(one["order"] for one in orders[pair]))

    def test_of_the_nearest_class_follow_from_its_pairs(self):
        names = ("comparison", "case", "budget_ms", "among")
        answers = rows("work_precision", "nearest.csv")
        pairs = by(rows("work_precision", "nearest_pairs.csv"), *names)
        for row in answers:
            with self.subTest(" ".join(row[name] for name in names)):
                of_other = by(pairs[tuple(row[name] for name in names)], "second")
                if "mean" not in row["case"]:  # the order of a mean has no distance
                    self.assertEqual([one["order"] for one in sum(of_other.values(), [])],
                                     [order(one) for one in sum(of_other.values(), [])])
                undecided = [other for (other,), of in of_other.items() if {one["order"] for one in of} != {"first_is_closer"}]
                self.assertEqual(row["either_of"].split(), undecided)
                self.assertEqual(int(row["others"]), len(of_other))


class TunedSettings(unittest.TestCase):
    """PBS and XPBD have the value with the least training error after 24 iterations, and delta mush has the best number of iterations, too.
    XPBD runs in plain code in `ensemble`."""
    def test_are_those_with_the_least_training_error_in_the_kept_record(self):
        text = (SOURCE / "experiments" / "studies" / "ensemble" / "cases.toml").read_text(encoding="utf-8")
        tuned = dict(re.findall(r'\[\[tuned\]\]\ndeformer = "(\w+)"\nkeys = \[(.*)\]', text))
        chosen = [row for row in rows("work_precision", "settings.csv")
                  if not row["wanted_vertices"] and row["training_error_joint_pct"]]
        code = {"xpbd": "plain_f64"}
        of = {name: [row for row in chosen if (row["deformer"], row["comparison"]) == (name, code.get(name, "packed_f32"))]
              for name in tuned}
        (pbs,), (xpbd,) = ([row for row in of[name] if row["iterations"] == "24"] for name in ("pbs", "xpbd"))
        mush = min(of["delta_mush"], key=lambda row: float(row["training_error_joint_pct"]))
        self.assertEqual(tuned["pbs"], f'"pbs.{self.key(pbs)}"')
        self.assertEqual(tuned["delta_mush"], f'"delta_mush.iterations={mush["iterations"]}"')
        self.assertEqual(mush["tuned"], "")
        factor = float(xpbd["tuned"].removeprefix("stiffness_factor_"))
        compared = tomllib.loads((SOURCE / "experiments/studies/work_precision/cases.toml").read_text(encoding="utf-8"))["deformer"]
        (order, _), = (of["codes"][1] for of in compared if of["name"] == "xpbd")
        young_pa = float(re.fullmatch(rf'"xpbd.young_pa=(.*)", "{order}"', tuned["xpbd"]).group(1))
        self.assertTrue(math.isclose(young_pa, factor * 1e5))  # of the flesh of the scenes

    def key(self, row):
        """k_stretch_0.5 -> k_stretch=0.5"""
        return "=".join(row["tuned"].rsplit("_", 1))


if __name__ == "__main__":
    unittest.main()
