"""The tables that studies conclude are computed a second time from the raw tables of the kept records. Reference: the
rules in the studies' pages. Nothing is shared with the program: the standard library reads the files, and raw tables
are kept with six digits."""
import collections
import csv
import gzip
import itertools
import math
import os
import pathlib
import re
import statistics
import unittest

RECORDS = pathlib.Path(os.environ["PBS_SOURCE"]) / "experiments" / "records" / "full"
ROUNDING = 5e-6  # of a kept raw number, relative: six digits
LAST_DIGITS = 1e-9  # of a number that both programs compute from the same digits, relative


def table(name):
    file = RECORDS / name
    with file.open(newline="") if file.exists() else gzip.open(f"{file}.gz", "rt", newline="") as stream:
        rows = list(csv.DictReader(stream))
    # A run without rows has its name alone.
    return [row for row in rows if any(cell for name, cell in row.items() if name != "run")]


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


def indexed(rows, *names):
    return {key(row, *names): row for row in rows}


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


def geometric_mean(ratios):
    """Without those that are not known."""
    logs = [math.log(ratio) for ratio in ratios if not math.isnan(ratio)]
    return math.exp(statistics.fmean(logs)) if logs else math.nan


class Concluded(unittest.TestCase):
    compared = 0

    def near(self, row, name, value, relative=LAST_DIGITS, absolute=0.0):
        stated = number(row[name])
        is_near = (stated == value or math.isnan(stated) and math.isnan(value)
                   or abs(stated - value) <= relative * abs(value) + absolute)
        self.assertTrue(is_near, f"{name}: {value}, {row}")
        self.compared += not math.isnan(value)

    def range_near(self, row, value, low, high, relative=LAST_DIGITS):
        for name, wanted in (("value", value), ("low", low), ("high", high)):
            self.near(row, name, wanted, relative)


class Merged(Concluded):
    def test_a_table_of_a_study_has_the_rows_of_its_runs(self):
        for file in sorted(RECORDS.glob("*/*.csv")):
            raw = file.parent / "runs" / ("measurements.csv" if file.name == "setup.csv" else file.name)
            if raw.exists():
                own, of_runs = (collections.Counter(tuple(map(six,
                                                              (row[name] for name in sorted(row) if name != "run")))
                                                    for row in table(path)) for path in (file, raw))
                self.assertEqual(own, of_runs, file)
                self.compared += own.total()
        self.assertGreater(self.compared, 1900)


class Cells(unittest.TestCase):
    """Some columns are for readers: sentences, sources, units and names of hardware. Everything else identifies a row
    or is a number. A joint is named by its two bones (upper|forearm), either_of and takes are lists, and a setting is a
    list of KEY=VALUE."""
    WORDS = {"bound", "bound_from", "cpu_model", "description", "note", "reason", "remark", "source", "unit",
             "verdict_changed"}
    WORDS_OF = {"points.csv": {"beside"}, "trials.csv": {"failure", "further_keys"}, "verification.csv": {"mesh"}}
    MORE = {"joint": "|", "setting": "= ", "either_of": " ", "takes": " "}

    def test_keys_are_identifiers_or_numbers(self):
        cells = 0
        for file in sorted(RECORDS.rglob("*.csv*")):
            name = file.relative_to(RECORDS).as_posix().removesuffix(".gz")
            rows = table(name)
            for column in rows[0] if rows else ():
                if column not in self.WORDS | self.WORDS_OF.get(name.rpartition("/")[2], set()):
                    allowed = re.compile(rf"[\w.+{self.MORE.get(column, '')}-]*", re.ASCII)
                    strange = {row[column] for row in rows if not allowed.fullmatch(row[column])}
                    self.assertEqual(strange, set(), f"{name}: {column}")
                    cells += len(rows)
        self.assertGreater(cells, 100_000)

    def test_each_row_of_the_verification_has_a_key_of_its_own(self):
        names = ("problem", "quantity", "setting", "element_order", "formulation", "material", "poisson", "h_m", "dofs")
        rows = table("verification/verification.csv")
        self.assertEqual(len({tuple(row[name] for name in names) for row in rows}), len(rows))
        self.assertGreater(len(rows), 200)


class AcrossStudies(Concluded):
    def test_values_that_several_studies_measure_are_the_same(self):
        parts = indexed((row for row in table("ensemble/runs/parts.csv")
                         if key(row, "k_stretch", "iterations") == ("0.2", "24")), "run")
        settings = grouped(table("convergence/runs/rates.csv"), "own_mesh", "order", "precision", "k_stretch", "start")
        paths = indexed(settings["1", "ordered", "f32", "0.2", "lbs"], "run", "pose")
        for pose, column, of_path in (("twist_90", "error_joint", "error_24"),
                                      ("twist_90", "discretisation", "reference_bound"),
                                      ("bend_60", "discretisation", "reference_bound")):
            path = paths[f"limb_{pose.split('_')[0]}", pose]
            self.near(parts[f"limb_{pose}",], f"{column}_pct", float(path[f"{of_path}_pct"]), 2.1 * ROUNDING)
        own_errors = indexed(table("references/references.csv"), "pose", "member")
        compared = table("work_precision/references.csv")
        for row in compared:
            self.assertLessEqual(row.items(), own_errors[key(row, "pose", "member")].items())
        self.assertGreater(len(compared), 300)


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
    PLAYED = ("clip", "method", "setting", "member", "start")

    def setUp(self):
        self.rows = collections.defaultdict(dict)
        for row in table("work_precision/errors.csv"):
            self.rows[row["table"], row["budget_ms"], row["method"]][row["pose"]] = row

    def ratios(self, row, stratum):
        """For each variant, the ratios to the errors of LBS in the poses that have the latter; errors.csv has no other
        time's."""
        own, lbs = (self.rows.get((row["table"], row["budget_ms"], method), {}) for method in (row["method"], "lbs"))
        poses = [pose for pose in own if own[pose]["stratum"] == stratum]
        variants = [name for name in next(iter(own.values()), ()) if name.endswith("_pct")]
        return [[number(own[pose][name]) / float(lbs[pose][name]) for pose in poses if lbs[pose][name]]
                for name in variants]

    def test_shares_and_profiles_follow_from_the_errors(self):
        tables = [table(f"work_precision/{name}.csv") for name in ("methods", "curves", "profiles")]
        for row in itertools.chain(*tables):
            for stratum, names in self.COLUMNS.items():
                ratios = self.ratios(row, stratum)
                shares = [share for share in map(geometric_mean, ratios) if not math.isnan(share)]
                for name in names if ratios and names[0] in row else ():
                    self.near(row, name,
                              (min if "low" in name else max if "high" in name else statistics.median)(shares))
                if ratios and stratum == "movement" and "poses" in row:
                    counts = [len(of) - sum(map(math.isnan, of)) for of in ratios]
                    self.assertEqual((int(row["poses"]), int(row["fewest_poses"])), (max(counts), min(counts)), row)
                if ratios and stratum == "movement" and "solved_pct" in row:
                    solved = [statistics.fmean(ratio <= 0.01 * float(row["target_pct"]) for ratio in of)
                              for of in ratios if of]
                    self.near(row, "solved_pct", 100.0 * statistics.fmean(solved))
        self.assertGreater(self.compared, 850)

    def test_times_and_distances_are_medians_over_the_poses_by_movement(self):
        methods = table("work_precision/methods.csv")
        self.assertEqual({(row["table"], row["budget_ms"], row["method"]) for row in methods}, set(self.rows))
        for row in methods:
            own = [of for of in self.rows[row["table"], row["budget_ms"], row["method"]].values()
                   if of["stratum"] == "movement"]
            for name in ("ms", "skin_mm"):
                self.near(row, name, statistics.median(float(of[name]) for of in own if of[name]))
            ms, budget_ms = float(row["ms"]), float(row["budget_ms"])
            self.assertEqual(row["within"], "doubled" if 2.0 * ms <= budget_ms else "once" if ms <= budget_ms else "no")
        self.assertGreater(self.compared, 140)

    def test_motion_follows_from_the_played_frames(self):
        played = grouped(table("work_precision/runs/played.csv"), *self.PLAYED)
        settings, motion = table("work_precision/methods.csv"), table("work_precision/motion.csv")
        lbs = {row["budget_ms"]: row["setting"] for row in settings if row["method"] == "lbs"}
        for row in motion:
            of_lbs = played[key(row | {"method": "lbs", "setting": lbs[row["budget_ms"]], "start": "cold"},
                                *self.PLAYED)]
            of_lbs = {of["pose"]: number(of["error_joint_pct"]) for of in of_lbs}
            for name, start in (("cold", "cold"), ("played", "frame_before")):
                own = played[key(row | {"start": start}, *self.PLAYED)]
                share = geometric_mean(number(of["error_joint_pct"]) / of_lbs[of["pose"]] for of in own
                                       if of["pose"] in of_lbs)
                self.near(row, f"{name}_share", share, 2.1 * ROUNDING)
                skin_mm = [float(of["skin_mm"]) for of in own if of["skin_mm"]]
                self.near(row, f"{name}_skin_mm", statistics.fmean(skin_mm) if skin_mm else math.nan, 1.1 * ROUNDING)
                self.near(row, "frames", sum(bool(of["error_joint_pct"]) for of in own))
            self.near(row, "ms", statistics.median(float(of["ms"]) for of in own), 1.1 * ROUNDING)
        shown = {(*case[:4], row["budget_ms"]) for row in settings for case in played
                 if key(row, "method", "setting") == case[1:3]}
        self.assertEqual({key(row, *self.PLAYED[:4], "budget_ms") for row in motion}, shown)
        self.assertGreater(self.compared, 1200)


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


class Stability(Concluded):
    """The sweeps of a body with and without the jiggling zone are counted together, as cells.csv does not tell them
    apart. It has the motion in the last of the ten steps alone, so that a body that does not move there may have moved
    before."""
    SWEEP = ("run", "body", "precision", "factor", "second_factor")
    MAP = ("factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision", "outcome", "steps",
           "last_inverted_tets", "recovery_steps")
    AT_REST = ("converged",), ("bounded", "inverted")
    COUNTED = {  # the states that certainly count, and those that may
        "diverged": (("diverged", "not_finite"), ()), "inverted": (("inverted", "inverted, moves"), ()),
        "at_rest": (("converged",), ()), "in_motion": (("bounded, moves", "inverted, moves"), ("bounded", "inverted")),
        "at_rest_in_small_steps": AT_REST, "at_rest_in_large_steps": AT_REST}

    def test_shares_are_those_of_the_outcomes(self):
        cells = [row | {"deformer": "pbs" if row["as_published"] == "yes" else row["model"]}
                 for row in table("stability/runs/cells.csv") if row["named"] != "not_used"]
        for cell in cells:
            if cell["outcome"] in ("bounded", "inverted") and float(cell["last_motion_diagonals"]) > 1e-5:
                cell["outcome"] += ", moves"
        cells = grouped(cells, *self.SWEEP, "deformer")
        for sweep, rows in grouped(table("stability/runs/measurements.csv"), *self.SWEEP, "deformer",
                                   "quantity").items():
            share = sweep[-1].removeprefix("share_of_cells_")
            first, last = 0.05 if "large" in share else 0.0, 0.1 if "small" in share else math.inf
            own = [cell["outcome"] for cell in cells[sweep[:-1]] if first <= float(cell["time_step_s"]) <= last]
            self.assertEqual(sum(int(row["n"]) for row in rows), len(own), sweep)
            certain, possible = (sum(map(own.count, states)) for states in self.COUNTED[share])
            counted = math.fsum(float(row["value"]) * int(row["n"]) for row in rows) - certain
            self.assertTrue(-LAST_DIGITS <= counted <= possible + LAST_DIGITS,
                            f"{sweep}: {counted} more than {certain}")
            self.compared += possible == 0
        self.assertGreater(self.compared, 500)

    def test_intervals_are_those_of_clopper_and_pearson(self):
        for row in table("stability/runs/measurements.csv"):
            n, held = int(row["n"]), round(float(row["value"]) * int(row["n"]))
            low, high = float(row["low"]), float(row["high"])
            self.near(row, "value", held / n)
            if row["quantity"].removeprefix("share_of_cells_") in ("inverted", "in_motion", "at_rest"):
                for end, is_trivial, counts in ((low, held == 0, range(held, n + 1)),
                                                (high, held == n, range(held + 1))):
                    tail = math.fsum(math.comb(n, k) * end ** k * (1.0 - end) ** (n - k) for k in counts)
                    self.assertTrue(end == (held == n) if is_trivial else abs(tail - 0.025) <= LAST_DIGITS, row)
            else:
                self.assertEqual((low, high), 2 * (float(row["value"]),))
        self.assertGreater(self.compared, 780)

    def test_maps_have_the_cells_of_two_factors(self):
        cells = grouped(table("stability/runs/cells.csv"), "factor", "second_factor")
        for factors in (("time_step", "k_stretch"), ("iterations", "twist")):
            of_map = [key(row, *self.MAP) for row in table(f"stability/map_{'_'.join(factors)}.csv")]
            self.assertEqual(of_map, [key(row, *self.MAP) for row in cells[factors]])
            self.assertGreater(len(of_map), 60)


class Convergence(Concluded):
    """The values on the meshes of about one size: that of the scene's own mesh, and the range. On a ladder each mesh
    has its own."""
    PATHS = ("run", "pose", "order", "precision", "k_stretch")

    def test_values_follow_from_the_paths(self):
        paths = grouped(table("convergence/runs/rates.csv"), *self.PATHS)
        for row in table("convergence/runs/measurements.csv"):
            is_control = row["deformer"] != "pbs" or row["initial_guess"] in ("lbs", "random")  # which rates.csv lacks
            if not is_control and not row["vertices_to"]:
                rows, own = indexed(paths[key(row | {"pose": self.pose_of(row)}, *self.PATHS)], "start",
                                    "vertices"), six(row["vertices"])
                meshes = [own,
                          *(mesh for guess, mesh in rows if guess == "lbs" and mesh != own
                            and "ladder" not in row["run"])]
                values = [self.value(row, rows[row["initial_guess"] or "lbs", mesh], rows["lbs", mesh])
                          for mesh in meshes]
                known = [value for value, _ in values if math.isfinite(value)]
                lacks = sum(limit is None for _, limit in values)
                low, high = (0.0, math.inf) if lacks else (min(known), max(known))
                self.range_near(row, values[0][0], low, high,
                                2.1 * ROUNDING if "error" in row["quantity"] else LAST_DIGITS)
                self.assertEqual((row["limit"], row["not_reached"]), (values[0][1], str(lacks or "")), row)
        self.assertGreater(self.compared, 7300)

    @staticmethod
    def pose_of(row):
        if row["motion"] == "range_of_motion":
            return row["pose"]
        named = (("", row["angle_deg"], ""), ("at_", row["time_s"], "_s"), ("", row["pose"], ""))
        return "_".join([row["motion"], *(before + six(cell) + after for before, cell, after in named if cell)])

    @staticmethod
    def value(row, guess, lbs):
        """A value, and what it bounds; None: there is no value."""
        if row["quantity"].startswith("error"):
            return number(guess["error_24_pct"]) / number(lbs["error_24_pct"]), ""
        one, other = ((int(of[f"iterations_to_{row['tolerance']}"]), of[f"{row['tolerance']}_reached"] == "1")
                      for of in (guess, lbs))
        if row["quantity"].startswith("iterations_to_tolerance"):
            return one[0], "" if one[1] else "more_than"
        if not one[1] and not other[1]:
            return math.nan, None
        return max(one[0], 1) / max(other[0], 1), "at_least" if not one[1] else "" if other[1] else "at_most"

    def test_exponents_are_slopes_along_a_ladder(self):
        rows = table("convergence/runs/measurements.csv")
        ladder = ("run", "body", "motion", "angle_deg", "pose", "deformer", "order", "precision", "k_stretch",
                  "tolerance", "initial_guess")
        sizes = grouped((row for row in rows if row["quantity"].startswith("iterations_to") and not row["limit"]),
                        *ladder)
        for row in (row for row in rows if row["vertices_to"]):
            points = sorted((float(of["vertices"]), float(of["value"])) for of in sizes[key(row, *ladder)]
                            if float(of["value"]) > 0.0)
            self.range_near(row, *fitted_slope(points, 0.99, 0.0)[0])
            self.assertEqual((points[0][0], points[-1][0]), (float(row["vertices"]), float(row["vertices_to"])))
        self.assertGreater(self.compared, 11)

    def test_the_floor_is_the_least_last_residual(self):
        for rows in grouped(table("convergence/runs/rates.csv"), *self.PATHS, "vertices").values():
            floor = min(float(row["last_residual"]) for row in rows if row["outcome"] == "finished")
            for row in rows:
                self.near(row, "floor", floor)
        self.assertGreater(self.compared, 1800)


def over(one, other, names=("value", "low", "high")):
    """The ratio of two measurements with its range."""
    (a, a_low, a_high), (b, b_low, b_high) = ([float(of[name]) for name in names] for of in (one, other))
    return a / b, a_low / b_high, a_high / b_low


def rank_correlation(x, y):
    ranks = [[statistics.fmean(k for k, other in enumerate(sorted(values)) if other == value) for value in values]
             for values in (x, y)]
    return statistics.correlation(*ranks) if all(min(own) < max(own) for own in ranks) else math.nan


class Jiggle(Concluded):
    SOLVER = ("run", "deformer", "order", "precision", "masses", "k_bind")
    SETTING = (*SOLVER, "k_stretch", "iterations", "time_step_s")

    def setUp(self):
        self.by_quantity = collections.defaultdict(list)
        for row in table("jiggle/runs/measurements.csv"):
            self.by_quantity[row["quantity"]].append(row)

    def test_values_are_those_of_the_responses(self):
        responses = table("jiggle/runs/responses.csv")
        for row in responses:
            row |= {"order": "plain", "precision": "f64", "time_step_s": six(1e-3 * float(row["time_step_ms"])),
                    "k_bind": "" if row["k_bind"] == "1" else row["k_bind"]}
        references = indexed((row for row in responses if row["deformer"] == "nh_p1"), "k_stretch", "iterations")
        responses = indexed(responses, *self.SETTING)
        columns = {"amplitude": 3 * ["overshoot_over_jolt"], "last_share_of_peak": 3 * ["left_over_peak"],
                   "damping_ratio": ["damping_ratio", "damping_low", "damping_high"],
                   "frequency_hz": ["frequency_hz", "frequency_low_hz", "frequency_high_hz"]}
        columns["damping_ratio_in_other_readings"] = columns["damping_ratio"]
        for quantity, names in columns.items():
            for row in self.by_quantity[quantity]:
                # responses.csv lacks the others.
                if key(row, "deformer", "order", "precision") == ("pbs", "plain", "f64"):
                    response = responses[key(row, *self.SETTING)]
                    self.range_near(row, *(number(response[name]) for name in names), 1.1 * ROUNDING)
        for row in self.by_quantity["frequency_over_reference"]:
            own, reference = responses[key(row, *self.SETTING)], references[key(row, "k_stretch", "iterations")]
            self.range_near(row, *over(own, reference, columns["frequency_hz"]), 2.1 * ROUNDING)
        self.assertGreater(self.compared, 900)

    def test_shares_and_ratios_of_frequencies(self):
        swings = {key(row, *self.SETTING) for row in self.by_quantity["damping_ratio"]}
        settings = grouped(self.by_quantity["last_share_of_peak"], "run", "order", "precision")
        for row in self.by_quantity["share_of_settings_that_swing"]:
            own = [key(of, *self.SETTING) in swings for of in settings[row["run"], "plain", "f64"]]
            self.range_near(row, *3 * [statistics.fmean(own)])
            self.assertEqual(int(row["n"]), len(own))
        frequencies = indexed(self.by_quantity["frequency_hz"], *self.SETTING)
        for row in self.by_quantity["frequency_ratio_at_twice_iterations"]:
            twice = frequencies[key(row | {"iterations": 2.0 * float(row["iterations"])}, *self.SETTING)]
            self.range_near(row, *over(twice, frequencies[key(row, *self.SETTING)]))
        for row in self.by_quantity["frequency_ratio_at_half_time_step"]:
            halves = [(of, frequencies.get(key(of | {"time_step_s": 0.5 * number(of["time_step_s"])}, *self.SETTING)))
                      for of in frequencies.values() if of["run"] == row["run"]]
            ratios = {key(of, *self.SETTING): over(half, of)[0] for of, half in halves if half}
            self.range_near(row, ratios[key(row, *self.SETTING)], min(ratios.values()), max(ratios.values()))
        self.assertGreater(self.compared, 60)

    def test_ratios_and_correlations_over_the_stiffness(self):
        for quantity, of in (("amplitude", "amplitude"), ("frequency", "frequency_hz")):
            series = [rows for rows in grouped(self.by_quantity[of], *self.SOLVER, "iterations", "time_step_s").values()
                      if len(rows) > 1]
            series = {key(rows[0], *self.SOLVER): sorted(rows, key=self.stiffness) for rows in series}
            names = f"{quantity}_ratio_over_k_stretch", f"rank_correlation_of_{quantity}_and_k_stretch"
            for row in (row for name in names for row in self.by_quantity[name]):
                papers = {"deformer": "pbs", "order": "plain", "precision": "f64",
                          "masses": "unit"} if quantity == "frequency" else {}
                rows = series[key(row | papers, *self.SOLVER)]
                points = [(self.stiffness(one), float(one["value"])) for one in rows]
                values = [value for _, value in points]
                if row["quantity"] == "frequency_ratio_over_k_stretch":
                    self.range_near(row, *over(rows[-1], rows[0]))
                elif "ratio" in row["quantity"]:
                    self.range_near(row, *3 * [max(values) / min(values) if min(values) else math.nan])
                else:
                    every = [rank_correlation(*zip(*points[:out], *points[out + 1:])) for out in range(len(points) + 1)]
                    self.range_near(row, every[-1], min(every), max(every))
        self.assertGreater(self.compared, 90)

    @staticmethod
    def stiffness(row):
        return number(row["k_stretch"] or row["young_pa"])


class Timing(Concluded):
    CASE = ("body", "motion", "pose", "angle_deg", "precision")

    def test_targets_follow_from_the_orders(self):
        names = (*self.CASE, "order", "sequence")
        orders = indexed(table("timing/runs/orders.csv"), *names)
        for row in table("timing/runs/targets.csv"):
            own, plain = orders[key(row, *names)], orders[key(row | {"order": "plain", "sequence": "file"}, *names)]
            column = "residual" if row["target"].startswith("residual") else "volume_abs_change"
            bound = {"volume_2_pct": 2.0, "volume_05_pct": 0.5}.get(row["target"])
            unit = "" if column == "residual" else "_pct"
            self.near(row, "bound", bound or number(plain[f"{column}_24{unit}"]))
            self.near(row, "limit", number(own[f"{column}_limit{unit}"]))
            if row["iterations"]:
                self.near(row, "ms", int(row["iterations"]) * float(own["iteration_ms"]), 2.1 * ROUNDING)
            self.assertEqual(row["reached"] == "1", bool(row["iterations"]), row)
        self.assertGreater(self.compared, 1400)

    def test_answers_are_ratios_of_the_targets(self):
        names = (*self.CASE, "order", "target", "sequence")
        targets = indexed(table("timing/runs/targets.csv"), *names)
        for row in table("timing/answers.csv"):
            own = targets[key(row | {"sequence": "file"}, *names)]
            for name in ("bound", "iterations", "ms", "limit"):
                self.near(row, name, number(own[name]), 1.1 * ROUNDING)
            for name, sequence in (("speedup_to_plain", "file"), ("speedup_to_plain_spread", "spread")):
                plain = targets[key(row | {"order": "plain", "sequence": sequence}, *names)]
                self.near(row, name, number(plain["ms"]) / number(own["ms"]), 2.1 * ROUNDING)
        self.assertGreater(self.compared, 380)

    def test_rates_and_ratios_follow_from_the_times(self):
        printed = indexed(table("audit/runs/printed.csv"), "model", "quantity")
        rows = indexed(table("timing/runs/timing.csv"), "run", "variant", "precision")
        for row in rows.values():
            for before, ms in (("", "total_wall_ms"), ("drawn_", "drawn_wall_ms"), ("paper_", "paper_ms")):
                self.near(row, f"{before}frames_per_s", 1e3 / number(row[ms]), 2.1 * ROUNDING)
            if row["vertices_over_table_1"]:
                bind, stretch = (printed[row["model"], f"{name}_constraints"] for name in ("bind", "stretch"))
                paper = {"vertices": float(bind["printed"]), "edges": float(stretch["printed"]),
                         "tets": float(stretch["most"]) / 6.0}
                for name, counted in paper.items():
                    self.near(row, f"{name}_over_table_1", float(row[name]) / counted, 1.1 * ROUNDING)
        for row in table("timing/runs/measurements.csv"):
            if row["deformer"] == "pbs":
                own, name = rows[key(row | {"variant": row["order"]}, "run", "variant", "precision")], row["quantity"]
                ms = [float(own[("total_ms" if "processor" in name else "total_wall_ms" if "frames" in name else name)
                                + end])
                      for end in ("", "_low", "_high")]
                paper = float(own["paper_frames_per_s"]) if "over" in name else 1.0
                values = [1e3 / one / paper for one in (ms[0], ms[2], ms[1])] if "frames" in name else ms
                self.range_near(row, *values, 1.1 * ROUNDING)
        self.assertGreater(self.compared, 800)

    def test_the_end_of_real_time_is_on_the_line_between_two_sizes(self):
        limit_ms = 1e3 / 30.0
        for row in table("timing/real_time.csv"):
            points = sorted((float(of["vertices"]), float(of["total_wall_ms"])) for of in table("timing/timing.csv")
                            if not of["model"] and key(of, "variant", "precision") == key(row, "variant", "precision"))
            (size, ms), other = next(pair for pair in zip(points, points[1:]) if pair[1][1] >= limit_ms
                                     or pair[1] == points[-1])
            exponent = math.log(other[1] / ms) / math.log(other[0] / size)
            self.near(row, "vertices", size * (limit_ms / ms) ** (1.0 / exponent))
            self.near(row, "exponent", fitted_slope(points)[0][0])
            self.near(row, "is_beyond", not points[0][0] <= float(row["vertices"]) <= points[-1][0])
        self.assertEqual(self.compared, 9)


class Audit(Concluded):
    """Table 1 by its own rows: as many bind constraints as vertices, and six edges a tet at most."""

    def test_bounds_follow_from_table_1(self):
        paper = {row["model"]: float(row["paper_frames_per_s"]) for row in table("timing/timing.csv") if row["model"]}
        of = indexed(table("audit/runs/printed.csv"), "quantity", "model")
        vertices = {model: float(of["bind_constraints", model]["printed"]) for model in paper}
        tets = {model: float(of["stretch_constraints", model]["most"]) / 6.0 for model in paper}
        for name, counts in (("vertices", vertices), ("tets", tets)):
            self.near(of[f"mean_{name}", ""], "least", 0.75 * statistics.fmean(counts.values()))
            self.near(of[f"mean_{name}", ""], "most", 1.25 * statistics.fmean(counts.values()))
        for model, rate in paper.items():
            self.near(of["stretch_constraints", model], "least", vertices[model] + tets[model] + 1.0)
            self.near(of["ct_total_of_1_s_ms", model], "least", 1e5 / (rate + 0.05) - 0.05)
            self.near(of["ct_total_of_1_s_ms", model], "most", 1e5 / (rate - 0.05) + 0.05)
        self.assertEqual(self.compared, 19)


class Ambiguity(Concluded):
    @staticmethod
    def holds(bound, value):
        first, _, last = bound.split()
        return (value <= float(first) if last == "less" else float(first) <= value
                and (last == "more" or value <= float(last)))

    def test_changes_and_verdicts_follow_from_the_values(self):
        for row in table("ambiguity/ambiguity.csv"):
            a, b = number(row["a"]), number(row["b"])
            self.near(row, "change", b - a)
            self.near(row, "b_over_a", b / a if a else math.nan)
            own = ["" if math.isnan(value) else "yes" if self.holds(row["bound"], value) else "no" for value in (a, b)]
            self.assertEqual([row["holds_a"], row["holds_b"]], own, row)
            flips = "no_value" if "" in own else "no" if own[0] == own[1] else "yes"
            self.assertEqual(row["verdict_flips"], flips, row)
        self.assertGreater(self.compared, 800)


class Ensemble(Concluded):
    def test_the_parts_are_vectors_whose_sum_is_the_error(self):
        models = indexed((row for row in table("ensemble/runs/attachments.csv") if row["difference_pct"] == "0"), "run",
                         "k_stretch")
        for row in table("ensemble/runs/parts.csv"):
            error, solver, model = (float(row[f"{name}_pct"]) for name in ("error_joint", "solver", "model"))
            self.assertTrue(abs(solver - model) <= error * (1 + 2 * ROUNDING) <= (solver + model) * (1 + 4 * ROUNDING),
                            row)
            self.near(models[key(row, "run", "k_stretch")], "model_pct", model)
        self.assertGreater(self.compared, 40)


class Verification(Concluded):
    SERIES = ("problem", "quantity", "setting", "element_order", "formulation", "material", "poisson")

    def test_differences_orders_and_verdicts_follow_from_the_values(self):
        for rows in grouped(table("verification/verification.csv"), *self.SERIES).values():
            for last, row in zip([None, *rows], rows):
                value, reference = number(row["value"]), number(row["reference"])
                if row["difference_pct"]:
                    self.near(row, "difference_pct", 100.0 * (value - reference) / abs(reference), absolute=1e-12)
                if row["observed_order"] and last and float(last["h_m"]) != float(row["h_m"]):
                    error, last_error = abs(value - reference), abs(number(last["value"]) - number(last["reference"]))
                    order = math.log(last_error / error) / math.log(float(last["h_m"]) / float(row["h_m"]))
                    self.near(row, "observed_order", order)
                if row["holds"]:
                    low, high = number(row["low"] or "-inf"), number(row["high"] or "inf")
                    holds = low <= value <= high and not abs(number(row["observed_order"])
                                                             - number(row["expected_order"])) > 0.1
                    self.assertEqual(row["holds"], "yes" if holds else "no", row)
        self.assertGreater(self.compared, 200)


if __name__ == "__main__":
    unittest.main()
