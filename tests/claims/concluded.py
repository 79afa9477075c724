"""The tables that studies conclude are computed a second time from the raw tables of the kept records. Reference: the
rules in the studies' pages. Nothing is shared with the program: the standard library reads the files, and raw tables
are kept with six digits."""
import collections
import csv
import gzip
import math
import os
import pathlib
import statistics
import unittest

RECORDS = pathlib.Path(os.environ["PBS_SOURCE"]) / "experiments" / "records" / "full"
ROUNDING = 5e-6  # of a kept raw number, relative: six digits
LAST_DIGITS = 1e-9  # of a number that both programs compute from the same digits, relative


def table(name):
    file = RECORDS / name
    with file.open(newline="") if file.exists() else gzip.open(f"{file}.gz", "rt", newline="") as stream:
        return list(csv.DictReader(stream))


def student_quantile(freedom, level=0.95):
    """The t that |t| does not exceed with this probability (Abramowitz and Stegun 26.7.3 and 26.7.4)."""
    def within(angle):
        term = total = 1.0 if freedom % 2 == 0 else math.cos(angle)
        for k in range(2 + freedom % 2, freedom - 1, 2):
            term *= math.cos(angle) ** 2 * (k - 1) / k
            total += term
        if freedom % 2 == 0:
            return math.sin(angle) * total
        return 2.0 / math.pi * (angle + (math.sin(angle) * total if freedom > 1 else 0.0))
    low, high = 0.0, math.pi / 2.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if within(middle) < level else (low, middle)
    return math.sqrt(freedom) * math.tan(low)


def fitted_slope(points):
    """The least squares slope of log y over log x with its 95 % range, and by how much the rounding of y can move them."""
    x, y = ([math.log(value) for value in values] for values in zip(*points))
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    weights = [value - mean_x for value in x]
    square = math.fsum(weight * weight for weight in weights)
    slope = math.fsum(map(math.prod, zip(weights, y))) / square
    moved = ROUNDING * math.fsum(map(abs, weights)) / square
    freedom = len(x) - 2
    if freedom < 1:
        return (slope, slope, slope), moved
    residual = math.fsum((value - mean_y - slope * weight) ** 2 for value, weight in zip(y, weights))
    per_residual = student_quantile(freedom) / math.sqrt(freedom * square)
    half = per_residual * math.sqrt(residual)
    return (slope, slope - half, slope + half), moved + per_residual * ROUNDING * math.sqrt(len(x))


class Stiffness(unittest.TestCase):
    """A case is everything that is not varied; its first series is file order on the meshes of the wanted sizes."""
    NAMES = {"exponent": "pbs_exponent", "xpbd_forgetting": "xpbd_forgetting_multipliers"}
    VARIED = {"iterations": "iterations", "time_step": "time_step_s", "resolution": "vertices"}  # and its field
    FIELDS = ("body", "deformer", "vertices", "k_stretch", "young_pa", "iterations", "time_step_s", "load", "ladder")
    NEAR_THE_PAPER = {"iterations": (12.0, 48.0), "time_step": (50.0, 200.0), "resolution": (0.0, math.inf)}

    def setUp(self):
        self.cases = {name: collections.defaultdict(lambda: collections.defaultdict(list)) for name in self.VARIED}
        for row in table("stiffness/runs/stiffness.csv"):
            varied = row["run"].rpartition("_")[0]
            step_s = 1e-3 * float(row["time_step_ms"])
            own = row | {"deformer": self.NAMES.get(row["method"], row["method"]), "time_step_s": f"{step_s:.9g}",
                         "ladder": "stepped" if row["by"] == "stepped" else ""}
            x = 1.0 / step_s if varied == "time_step" else float(row[self.VARIED[varied]])
            own["k_stretch" if row["method"].startswith("xpbd") else "young_pa"] = ""
            own[self.VARIED[varied]] = ""
            if row["converged"] == "1" and 0.0 < float(row["stiffness_n_m"]) < math.inf:
                series = self.cases[varied][self.key(own)]
                series[int(row["order_seed"]), row["mesh"] != "wanted"].append((x, float(row["stiffness_n_m"])))
        for cases in self.cases.values():
            for points in (points for series in cases.values() for points in series.values()):
                points.sort()

    def key(self, row, *without):
        return tuple("" if name in without or not row[name] else
                     row[name] if name in ("body", "deformer", "load", "ladder") else float(row[name])
                     for name in self.FIELDS)

    def test_exponents_are_slopes_of_the_first_series(self):
        exponents = table("stiffness/exponents.csv")
        for row in exponents:
            series = self.cases[row["varied"]][self.key(row)]
            (slope, low, high), moved = fitted_slope(series[min(series)])
            self.assertEqual(int(row["points"]), len(series[min(series)]), row)
            for name, value in (("exponent", slope), ("exponent_low", low), ("exponent_high", high)):
                self.assertLessEqual(abs(float(row[name]) - value), moved + LAST_DIGITS, f"{name}: {value}, {row}")
        every = [series for cases in self.cases.values() for series in cases.values()]
        self.assertEqual(len(exponents), sum(len(series[min(series)]) > 1 for series in every))

    def test_ratios_are_those_of_the_first_series_and_range_over_all(self):
        ratios = table("stiffness/runs/measurements.csv")
        for row in ratios:
            varied = row["run"].rpartition("_")[0]
            series = self.cases[varied][self.key(row, self.VARIED[varied])]
            first, last = self.NEAR_THE_PAPER[varied]
            near = [[point for point in series[name] if first * (1 - 1e-9) <= point[0] <= last * (1 + 1e-9)]
                    for name in sorted(series)]
            near = [points for points in near if len(points) > 1]
            single = [self.doubling(*pair) for points in near for pair in zip(points, points[1:])]
            wanted = {"value": self.doubling(near[0][0], near[0][-1]), "low": min(single), "high": max(single)}
            for name, (value, moved) in wanted.items():
                moved += LAST_DIGITS * value
                self.assertLessEqual(abs(float(row[name]) - value), moved, f"{name}: {value}, {row}")
        self.assertGreater(len(ratios), 200)

    @staticmethod
    def doubling(once, more):
        doublings = math.log2(more[0] / once[0])
        ratio = (more[1] / once[1]) ** (1.0 / doublings)
        return ratio, ratio * 2.1 * ROUNDING / doublings


class WorkPrecision(unittest.TestCase):
    """A share is the geometric mean over poses of the error over that of LBS: its median and ends over the variants."""
    COLUMNS = {"movement": ("share", "share_low", "share_high"), "fold": ("fold_share", "fold_low", "fold_high")}

    def test_shares_follow_from_the_errors(self):
        rows = collections.defaultdict(dict)
        for row in table("work_precision/errors.csv"):
            rows[row["table"], row["budget_ms"], row["method"]][row["pose"]] = row
        for row in table("work_precision/methods.csv"):
            own, lbs = (rows[row["table"], row["budget_ms"], method] for method in (row["method"], "lbs"))
            for stratum, names in self.COLUMNS.items():
                poses = [pose for pose in own if own[pose]["stratum"] == stratum and pose in lbs]
                logs = [[math.log(float(own[pose][variant]) / float(lbs[pose][variant])) for pose in poses
                         if own[pose][variant] and lbs[pose][variant]] for variant in next(iter(own.values()))
                        if variant.endswith("_pct")]
                shares = [math.exp(statistics.fmean(values)) for values in logs if values]
                for name, value in zip(names, (statistics.median(shares), min(shares), max(shares))):
                    self.assertLessEqual(abs(float(row[name]) / value - 1.0), LAST_DIGITS, f"{name}: {value}, {row}")


class Volume(unittest.TestCase):
    """The quantiles over the frames of a run, by linear interpolation between the sorted values."""
    ENDS = {"least": 0.0, "p10": 0.1, "median": 0.5, "p90": 0.9, "most": 1.0}
    SETTING = ("run", "scene", "deformer", "variant", "order", "precision", "iterations")

    def test_statistics_follow_from_the_frames(self):
        frames, compared = collections.defaultdict(list), 0
        for row in table("volume/runs/metrics.csv"):
            frames[tuple(row[name] for name in self.SETTING)].append(row)
        for row in table("volume/runs/frame_statistics.csv"):
            of_run = frames.get(tuple(row[name] for name in self.SETTING), [])
            if len(of_run) != int(row["frames"]):  # metrics.csv keeps the frames of those deformers that claims select
                continue
            for metric in ("volume_change", "volume_abs_change"):
                values = sorted(float(frame[f"{metric}_pct"]) for frame in of_run)
                moved = 2.0 * ROUNDING * max(map(abs, values))
                for end, share in self.ENDS.items():
                    place = share * (len(values) - 1)
                    low, high = values[math.floor(place)], values[math.ceil(place)]
                    value, name = low + (high - low) * (place % 1.0), f"{metric}_{end}_pct"
                    self.assertLessEqual(abs(float(row[name]) - value), moved, f"{name}: {value}, {row}")
                    compared += 1
        self.assertGreater(compared, 14_000)


if __name__ == "__main__":
    unittest.main()
