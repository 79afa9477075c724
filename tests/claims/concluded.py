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
        rows = list(csv.DictReader(stream))
    return [row for row in rows if any(cell for name, cell in row.items() if name != "run")]  # a run without rows has its name alone


def number(cell):
    return float(cell or "nan")


def six(cell):
    """A cell as raw tables keep it."""
    try:
        return f"{float(cell):.6g}"
    except ValueError:
        return cell


def key(row, *names):
    return tuple(six(row[name]) for name in names)


def grouped(rows, *names):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[key(row, *names)].append(row)
    return groups


def student_quantile(freedom, level):
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


def fitted_slope(points, level=0.95, rounding=ROUNDING):
    """The least squares slope of log y over log x with its range, and by how much the rounding of y can move them."""
    x, y = ([math.log(value) for value in values] for values in zip(*points))
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    weights = [value - mean_x for value in x]
    square = math.fsum(weight * weight for weight in weights)
    slope = math.fsum(map(math.prod, zip(weights, y))) / square
    moved = rounding * math.fsum(map(abs, weights)) / square
    freedom = len(x) - 2
    if freedom < 1:
        return (slope, slope, slope), moved
    residual = math.fsum((value - mean_y - slope * weight) ** 2 for value, weight in zip(y, weights))
    per_residual = student_quantile(freedom, level) / math.sqrt(freedom * square)
    half = per_residual * math.sqrt(residual)
    return (slope, slope - half, slope + half), moved + per_residual * rounding * math.sqrt(len(x))


class Concluded(unittest.TestCase):
    compared = 0

    def near(self, row, name, value, relative=LAST_DIGITS, absolute=0.0):
        stated = number(row[name])
        is_near = stated == value or math.isnan(stated) and math.isnan(value) or abs(stated - value) <= relative * abs(value) + absolute
        self.assertTrue(is_near, f"{name}: {value}, {row}")
        self.compared += 1

    def range_near(self, row, value, low, high, relative=LAST_DIGITS):
        for name, wanted in (("value", value), ("low", low), ("high", high)):
            self.near(row, name, wanted, relative)


class Merged(Concluded):
    def test_a_table_of_a_study_has_the_rows_of_its_runs(self):
        for file in sorted(RECORDS.glob("*/*.csv")):
            raw = file.parent / "runs" / ("measurements.csv" if file.name == "setup.csv" else file.name)
            if raw.exists():
                own, of_runs = (collections.Counter(tuple(map(six, (row[name] for name in sorted(row) if name != "run")))
                                                    for row in table(path)) for path in (file, raw))
                self.assertEqual(own, of_runs, file)
                self.compared += own.total()
        self.assertGreater(self.compared, 2500)


class Stiffness(Concluded):
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
                series = self.cases[varied][key(own, *self.FIELDS)]
                series[int(row["order_seed"]), row["mesh"] != "wanted"].append((x, float(row["stiffness_n_m"])))
        for cases in self.cases.values():
            for points in (points for series in cases.values() for points in series.values()):
                points.sort()

    def test_exponents_are_slopes_of_the_first_series(self):
        exponents = table("stiffness/exponents.csv")
        for row in exponents:
            series = self.cases[row["varied"]][key(row, *self.FIELDS)]
            (slope, low, high), moved = fitted_slope(series[min(series)])
            self.assertEqual(int(row["points"]), len(series[min(series)]), row)
            for name, value in (("exponent", slope), ("exponent_low", low), ("exponent_high", high)):
                self.near(row, name, value, 0.0, moved + LAST_DIGITS)
        every = [series for cases in self.cases.values() for series in cases.values()]
        self.assertEqual(len(exponents), sum(len(series[min(series)]) > 1 for series in every))

    def test_ratios_are_those_of_the_first_series_and_range_over_all(self):
        ratios = table("stiffness/runs/measurements.csv")
        for row in ratios:
            varied = row["run"].rpartition("_")[0]
            series = self.cases[varied][key(row | {self.VARIED[varied]: ""}, *self.FIELDS)]
            first, last = self.NEAR_THE_PAPER[varied]
            near = [[point for point in series[name] if first * (1 - 1e-9) <= point[0] <= last * (1 + 1e-9)]
                    for name in sorted(series)]
            near = [points for points in near if len(points) > 1]
            single = [self.doubling(*pair) for points in near for pair in zip(points, points[1:])]
            wanted = {"value": self.doubling(near[0][0], near[0][-1]), "low": min(single), "high": max(single)}
            for name, (value, moved) in wanted.items():
                self.near(row, name, value, absolute=moved)
        self.assertGreater(self.compared, 600)

    @staticmethod
    def doubling(once, more):
        doublings = math.log2(more[0] / once[0])
        ratio = (more[1] / once[1]) ** (1.0 / doublings)
        return ratio, ratio * 2.1 * ROUNDING / doublings


class WorkPrecision(Concluded):
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
                    self.near(row, name, value)
        self.assertGreater(self.compared, 300)


class Volume(Concluded):
    """The quantiles over the frames of a run, by linear interpolation between the sorted values."""
    ENDS = {"least": 0.0, "p10": 0.1, "median": 0.5, "p90": 0.9, "most": 1.0}
    SETTING = ("run", "scene", "deformer", "variant", "order", "precision", "iterations")

    def test_statistics_follow_from_the_frames(self):
        frames = grouped(table("volume/runs/metrics.csv"), *self.SETTING)
        for row in table("volume/runs/frame_statistics.csv"):
            of_run = frames[key(row, *self.SETTING)]
            if len(of_run) != int(row["frames"]):  # metrics.csv keeps the frames of those deformers that claims select
                continue
            for metric in ("volume_change", "volume_abs_change"):
                values = sorted(float(frame[f"{metric}_pct"]) for frame in of_run)
                moved = 2.0 * ROUNDING * max(map(abs, values))
                for end, share in self.ENDS.items():
                    place = share * (len(values) - 1)
                    low, high = values[math.floor(place)], values[math.ceil(place)]
                    self.near(row, f"{metric}_{end}_pct", low + (high - low) * (place % 1.0), 0.0, moved)
        self.assertGreater(self.compared, 14_000)


if __name__ == "__main__":
    unittest.main()
