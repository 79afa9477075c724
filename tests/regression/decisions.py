"""The decisions between pairs of methods follow from the errors that a study recorded. This is a second computation of
them, which needs numpy and shares no code with the program. Reference: the rules in
analysis/statistics/paired_comparison.hpp.

    decisions.py FOLDER        errors.csv, references.csv, pairs.csv and decisions.csv of the study's folder, or of
                               work_precision in a folder of studies
    decisions.py               the kept records
"""
import argparse
import bisect
import collections
import csv
import dataclasses
import functools
import itertools
import math
import pathlib
import random
import statistics
import sys
import unittest

import numpy

KEPT = pathlib.Path(__file__).resolve().parents[2] / "experiments" / "records" / "full"
STUDY = "work_precision"
TABLES = ("errors", "references", "pairs", "decisions")
SIGNIFICANCE, TIED_SHARE, LEVEL_RATIO, REPLICATES = 0.05, 0.8, 1.1, 2000
PRECISION = 1e-9        # of p and of ratios, relative
RANGE_PRECISION = 0.15  # of the ends of a range, whose random numbers differ, relative to its width in logarithms
LEVEL_PRECISION = 0.02  # of the thresholds of `level`, where a range is not recorded
folder = None  # of the study; set by the command line


# The comparison.

@dataclasses.dataclass
class Member:
    """Two methods on one reference."""
    wins: int
    ties: int
    losses: int
    p: float
    ratio: float
    log_ratio: dict  # by usable pose
    p_holm: float = 1.0


def number(text):
    return float(text) if text else math.nan


def sign_test(wins, losses):
    n, most = wins + losses, max(wins, losses)
    return min(1.0, 2 * sum(math.comb(n, i) for i in range(most, n + 1)) / 2 ** n)


def holm(p):
    """The largest product, over all smaller or equal p, of such a p with the number of those that are not smaller than
    it."""
    ascending = sorted(p)
    products = (smaller * (len(p) - bisect.bisect_left(ascending, smaller)) for smaller in ascending)
    largest = dict(zip(ascending, itertools.accumulate(products, max)))
    return [min(1.0, largest[own]) for own in p]


def compared(first, second, own_error):
    """first, second, own_error: pose -> number, or NaN."""
    log_ratio, signs = {}, collections.Counter()
    for pose, u in own_error.items():
        a, b = first.get(pose, math.nan), second.get(pose, math.nan)
        if not any(map(math.isnan, (a, b, u))):
            log_ratio[pose] = math.log(b / a)
            signs["tie" if abs(a - b) <= u else "win" if a < b else "loss"] += 1
    ratio = math.exp(statistics.fmean(log_ratio.values())) if log_ratio else math.nan
    return Member(signs["win"], signs["tie"], signs["loss"], sign_test(signs["win"], signs["loss"]), ratio, log_ratio)


def ends(means):
    """The range that leaves a fortieth of the means beyond each end."""
    beyond = REPLICATES // 40
    return math.exp(means[beyond]), math.exp(means[-1 - beyond])


def is_quantile(end, means, sign=1):
    """Whether a fortieth of the means lies below the end, or above it (sign -1). The difference of two such shares of
    2,000 replicates has the standard deviation sqrt(2 0.025 0.975 / 2000) = 0.005, four of which are allowed. The means
    of few bodies that lie far apart have gaps, in which an end is not determined more closely."""
    below = sum(sign * (mean - math.log(end)) < -PRECISION for mean in means)
    not_above = sum(sign * (mean - math.log(end)) < PRECISION for mean in means)
    return below <= 0.045 * REPLICATES and not_above >= 0.005 * REPLICATES


@functools.cache
def replicates(bodies):
    """Draws bodies with replacement, and poses in each of them, with another generator and seed than those of the
    record. Returns how often each replicate has each pose, REPLICATES x #poses. bodies: the poses of each body."""
    draw = random.Random(1).choices
    drawn = ([pose for body in draw(bodies, k=len(bodies)) for pose in draw(body, k=len(body))]
             for _ in range(REPLICATES))
    return numpy.array([[counted[pose] for body in bodies for pose in body]
                        for counted in map(collections.Counter, drawn)])


@functools.cache
def sorted_means(log_ratio, bodies):
    """Returns the mean logarithm of each replicate. log_ratio: pairs of a pose and its logarithm."""
    value, counted = dict(log_ratio), replicates(bodies)
    sums = (counted * [value[pose] for body in bodies for pose in body]).sum(axis=1)
    return numpy.sort(sums / counted.sum(axis=1)).tolist()


class Comparison:
    """All pairs of one table: {(first, second): {member: Member}}."""
    def __init__(self, errors, own_errors, body_of, pairs):
        """errors: {method: {member: {pose: number}}}; own_errors: {member: {pose: number}}; body_of: {pose: body}."""
        self.body_of = body_of
        self.pairs = {(a, b): {name: compared(errors[a][name], errors[b][name], u) for name, u in own_errors.items()}
                      for a, b in pairs}
        for name in own_errors:
            members = [of_pair[name] for of_pair in self.pairs.values()]
            for member, adjusted in zip(members, holm([member.p for member in members])):
                member.p_holm = adjusted

    def means(self, member):
        bodies = collections.defaultdict(list)
        for pose in member.log_ratio:
            bodies[self.body_of[pose]].append(pose)
        return sorted_means(tuple(member.log_ratio.items()), tuple(map(tuple, bodies.values())))

    def range_of(self, member):
        return ends(self.means(member))


def is_close(low, high, slack):
    """Whether a range lies within 1 / LEVEL_RATIO to LEVEL_RATIO."""
    return max(high, 1 / low) <= LEVEL_RATIO * (1 + slack)


def is_level(members, range_of, slack=0.0):
    """range_of: Member -> the ends of its range; called only where the ratio itself is close to 1, since a range
    contains its ratio."""
    return bool(members) and all(member.ties / len(member.log_ratio) >= TIED_SHARE or
                                 (is_close(member.ratio, member.ratio, slack) and is_close(*range_of(member), slack))
                                 for member in members)


def decision(members, level):
    """members: those with a usable pose."""
    directions = {0 if member.p_holm >= SIGNIFICANCE else 1 if member.wins > member.losses else -1
                  for member in members}
    if level:
        return "level"
    return {(1,): "first_is_nearer", (-1,): "second_is_nearer"}.get(tuple(directions),
                                                                    "depends" if {1, -1} <= directions else "open")


# The tables of a study.

def read(folder):
    return {name: list(csv.DictReader((folder / f"{name}.csv").read_text(encoding="utf-8").splitlines()))
            for name in TABLES}


class Study:
    """The errors and references that take part in decisions, and what pairs.csv and decisions.csv state."""
    def __init__(self, tables):
        self.members = [column.removesuffix("_pct") for column in tables["errors"][0] if column.endswith("_pct")]
        self.body_of = {row["pose"]: row["body"] for row in tables["references"] if row["stratum"] == "movement"}
        self.own_errors = {name: dict.fromkeys(self.body_of, math.nan) for name in self.members}
        for row in tables["references"]:
            if row["pose"] in self.body_of:
                self.own_errors[row["member"]][row["pose"]] = number(row["own_error_pct"])
        self.errors = collections.defaultdict(dict)  # (table, budget): {method: {member: {pose: number}}}
        for row in tables["errors"]:
            if row["stratum"] == "movement":
                by_member = self.errors[self.key(row)].setdefault(row["method"], {name: {} for name in self.members})
                for name in self.members:
                    if (row["pose"] not in self.body_of or row["pose"] in by_member[name]
                        or row["body"] != self.body_of[row["pose"]]):
                        raise ValueError(f"errors.csv: {row['method']}, {row['pose']}: not a pose of references.csv, "
                                         "or twice")
                    by_member[name][row["pose"]] = number(row[f"{name}_pct"])
        self.pairs, self.decisions = collections.defaultdict(dict), collections.defaultdict(dict)
        for row in tables["pairs"]:
            self.add(self.pairs, row, (row["first"], row["second"], row["member"]))
        for row in tables["decisions"]:
            self.add(self.decisions, row, (row["without_body"], row["first"], row["second"]))

    @staticmethod
    def key(row):
        return row["table"], number(row["budget_ms"])

    def add(self, results, row, key):
        if key in results[self.key(row)]:
            raise ValueError(f"{key} is stated twice for {self.key(row)}")
        results[self.key(row)][key] = row

    def comparison(self, key, pairs, without_body=""):
        kept = {pose: body for pose, body in self.body_of.items() if body != without_body}
        own_errors = {name: {pose: u for pose, u in by_pose.items() if pose in kept}
                      for name, by_pose in self.own_errors.items()}
        return Comparison(self.errors[key], own_errors, kept, pairs)


def differences(tables):
    """What the tables state and this computation does not, one line each."""
    study = Study(tables)
    compared_keys = {key for key, methods in study.errors.items() if len(methods) > 1}
    if not compared_keys == set(study.pairs) == set(study.decisions):
        return [f"errors.csv has {sorted(compared_keys)}, pairs.csv {sorted(study.pairs)}, decisions.csv "
                f"{sorted(study.decisions)}"]
    return [f"{table}, {budget_ms:g} ms: {line}" for table, budget_ms in sorted(compared_keys)
            for line in differences_of_table(study, (table, budget_ms))]


def differences_of_table(study, key):
    pairs = list(dict.fromkeys((first, second) for first, second, _ in study.pairs[key]))
    if sorted(map(sorted, pairs)) != sorted(map(sorted, itertools.combinations(study.errors[key], 2))):
        return ["pairs.csv does not have each pair of methods once"]
    bodies = sorted(set(study.body_of.values()))
    left_out = ["", *bodies] if len(bodies) > 1 else [""]
    if set(study.decisions[key]) != {(body, *pair) for body in left_out for pair in pairs}:
        return ["decisions.csv does not have each pair with all bodies and without each of them"]
    comparison = study.comparison(key, pairs)
    lines = [f"{pair} on {name}: {line}" for pair, members in comparison.pairs.items()
             for name, member in members.items()
             for line in differences_of_member(comparison, member, study.pairs[key].get((*pair, name)))]
    for body in left_out:
        lines += differences_of_decisions(study, key, pairs, body)
    return lines


def differences_of_member(comparison, member, row):
    if row is None:
        return ["not in pairs.csv"] if member.log_ratio else []
    lines = [f"{name} = {row[name]}, recomputed {getattr(member, name)}" for name in ("wins", "ties", "losses")
             if int(row[name]) != getattr(member, name)]
    for name in ("p", "p_holm", "ratio"):
        stated, own = number(row[name]), getattr(member, name)
        if not (math.isclose(stated, own, rel_tol=PRECISION) or math.isnan(stated) and math.isnan(own)):
            lines.append(f"{name} = {row[name]}, recomputed {own:.17g}")
    if not member.log_ratio:
        return lines
    low, high = number(row["ratio_low"]), number(row["ratio_high"])
    if not low * (1 - PRECISION) <= member.ratio <= high * (1 + PRECISION):
        return [*lines, f"the range {low} to {high} does not contain the ratio {member.ratio}"]
    means = comparison.means(member)
    own_low, own_high = ends(means)
    margin = RANGE_PRECISION * math.log(own_high / own_low) + PRECISION
    if not ((abs(math.log(low / own_low)) <= margin or is_quantile(low, means)) and
            (abs(math.log(high / own_high)) <= margin or is_quantile(high, means, -1))):
        lines.append(f"the range {low} to {high}, recomputed {own_low} to {own_high}")
    return lines


def differences_of_decisions(study, key, pairs, without_body):
    """With all bodies the ranges are those of pairs.csv. Without one they are drawn here, and `level` may differ near
    its thresholds."""
    lines, comparison = [], study.comparison(key, pairs, without_body)
    for pair in pairs:
        usable = {name: member for name, member in comparison.pairs[pair].items() if member.log_ratio}
        members = list(usable.values())
        if without_body:
            at_most = is_level(members, comparison.range_of, LEVEL_PRECISION)
            levels = {at_most, at_most and is_level(members, comparison.range_of, -LEVEL_PRECISION)}
        else:
            stated = {id(member): study.pairs[key].get((*pair, name)) for name, member in usable.items()}
            if None in stated.values():
                continue  # reported above
            levels = {is_level(members, lambda member: [number(stated[id(member)][end])
                                                        for end in ("ratio_low", "ratio_high")])}
        own = {decision(members, level) for level in levels}
        row = study.decisions[key][without_body, *pair]
        if row["decision"] not in own:
            lines.append(f"{pair} without {without_body or 'no body'}: {row['decision']}, "
                         f"recomputed {' or '.join(sorted(own))}")
    return lines


def study_folder(given):
    for candidate in (given, given / STUDY):
        if all((candidate / f"{name}.csv").is_file() for name in TABLES):
            return candidate
    return None


class Recorded(unittest.TestCase):
    def test_decisions_follow_from_the_errors(self):
        self.assertEqual(differences(read(folder)), [])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path, default=KEPT)
    given = parser.parse_args().folder
    folder = study_folder(given)
    if not folder:
        parser.error(f"{given}: expected a folder with {', '.join(f'{name}.csv' for name in TABLES)}")
    unittest.main(argv=sys.argv[:1])
