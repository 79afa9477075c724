"""Reads recorded results by name. RecordsMissing names the file, the column or the rows that do not exist.

    run = Run(results / "volume" / "limb_twist")
    rows = run.select(deformer="pbs", iterations=24)
    angle_deg, change_pct = numbers(rows, "angle_deg"), numbers(rows, "volume_change_pct")
"""
import csv
import hashlib
import json
import math


class RecordsMissing(Exception):
    pass


class RecordsDamaged(RecordsMissing):
    """Records that exist and cannot be read."""


def need(found, message):
    """Raises RecordsMissing with this message if nothing was found."""
    if not found:
        raise RecordsMissing(message)


class Run:
    """The directory of a run: run.json and metrics.csv (one row per deformer and frame)."""

    def __init__(self, folder):
        self.folder = folder
        self.name = folder.name
        self.record = read_json(folder / "run.json")
        self.rows = table(folder / "metrics.csv", {"scene", "deformer", "variant", "iterations", "frame", "time_s"})

    def select(self, deformer, iterations=None, variant="default"):
        """The deformer's rows, ordered by frame."""
        rows = [row for row in self.rows if is_of(row, deformer, variant, iterations)]
        need(rows, f"{self.folder / 'metrics.csv'}: no rows of {in_words(deformer, variant, iterations)}")
        return sorted(rows, key=lambda row: int(float(row["frame"])))

    def has(self, deformer, variant="default"):
        """Whether the deformer has a row; a reference whose budget of time was spent before its first frame has
        none."""
        return any(is_of(row, deformer, variant, None) for row in self.rows)

    def statistics(self, deformer, iterations=None, variant="default"):
        """Order statistics of the deformer over the frames: a row of frame_statistics.csv."""
        rows = frame_statistics(self.folder, deformer, variant, iterations)
        if len(rows) != 1:
            raise RecordsMissing(f"{self.folder / 'frame_statistics.csv'}: {len(rows)} rows of "
                                 f"{in_words(deformer, variant, iterations)}, expected one")
        return rows[0]

    def reference(self, needed=True):
        """The deformer that serves as the reference. Kept records have no scene that names it: there it is the one
        whose error is 0 in each frame, or else the last linear FEM deformer. Empty if none is needed."""
        name, all_of = self.record.get("scene", {}).get("reference",
                                                        {}).get("name"), {row["deformer"] for row in self.rows}
        wrong = {row["deformer"] for row in self.rows if row.get("error_joint_pct") != "0"}
        exact = sorted(all_of - wrong) + sorted(of for of in wrong if of.startswith("fem_"))[-1:]
        if name or exact or not needed:
            return name or (exact or [""])[0]
        raise RecordsMissing(f"{self.folder / 'metrics.csv'}: no FEM reference")

    def pbs_iterations(self):
        """The iteration counts with which the paper's PBS was run."""
        return sorted({int(float(row["iterations"])) for row in self.rows if is_of(row, "pbs", "default")
                       and row["iterations"]})


def is_of(row, deformer, variant, iterations=None):
    """Whether the row is of this setting; without a number of iterations, of any number."""
    chosen = iterations is None or (row["iterations"] and int(float(row["iterations"])) == iterations)
    return chosen and row["deformer"] == deformer and (row["variant"] or "default") == variant


def in_words(deformer, variant, iterations):
    return f"deformer {deformer}, variant {variant}" + (f", {iterations} iterations" if iterations is not None else "")


def frame_statistics(folder, deformer, variant="default", iterations=None):
    """A deformer's rows of frame_statistics.csv: for each setting, the order statistics over the run's frames."""
    file = folder / "frame_statistics.csv"
    need(file.is_file(), f"{file}: does not exist: the run is of an earlier version and has to be made again")
    rows = table(file, {"deformer", "variant", "iterations", "frames"})
    return [row for row in rows if is_of(row, deformer, variant, iterations)]


def numbers(rows, column):
    """The column as floats. An empty cell is nan; a column that is missing or empty throughout is an error."""
    if column not in rows[0]:
        raise RecordsMissing(f"{_place(rows[0])}: no column {column}")
    values = [float(row[column]) if row[column] not in ("", None) else math.nan for row in rows]
    if all(math.isnan(value) for value in values):
        raise RecordsMissing(f"{_place(rows[0])}: column {column} is empty for "
                             f"{rows[0].get('deformer') or rows[0].get('quantity')}")
    return values


def _place(row):
    """The table that a row comes from."""
    return f"metrics.csv of {row['scene']}" if "scene" in row else f"verification.csv, {row.get('problem', '')}"


def at_angle(rows, angle_deg):
    """The row of a sweep at this angle."""
    for row, angle in zip(rows, numbers(rows, "angle_deg")):
        if math.isclose(angle, angle_deg, abs_tol=1e-6):
            return row
    raise RecordsMissing(f"metrics.csv of {rows[0]['scene']}: no frame at {angle_deg:g} degrees")


def scene_hash(record):
    """Digest of the resolved scene, or of a study's own work, for a figure's metadata."""
    return hashlib.sha256(json.dumps(record.get("scene", record.get("work", {})),
                                     sort_keys=True).encode()).hexdigest()[:12]


def origin_of(runs):
    """Every version, revision, processor and scene of the runs (name -> content of its run.json), for a figure's
    metadata and caption."""
    origins = [record.get("provenance", {}) for record in runs.values()]
    found = {key: " and ".join(dict.fromkeys(origin[key] for origin in origins if origin.get(key)))
             for key in ("version", "git_revision", "cpu_model")}
    scenes = {name: scene_hash(record) for name, record in runs.items() if record.get("scene") or record.get("work")}
    return {key: text for key, text in found.items() if text} | {"git_dirty": any(origin.get("git_dirty")
                                                                                  for origin in origins),
                                                                 "scenes": scenes}


def is_reached(row):
    """Whether the deformer reached the pose of the frame. A run writes its frame even if the solve failed; a pose that
    was not reached cannot serve as a reference. A record of an earlier version has no outcome and counts as reached."""
    return row.get("outcome") in (None, "", "finished")


def provenance(results):
    """Version and git revision of the first run in a folder or below."""
    files = sorted(file for file in results.glob("**/run.json") if not file.parent.name.startswith("."))
    need(files, f"{results}: no run.json in it or below")
    return read_json(files[0]).get("provenance", {})


def read_json(file):
    """Reads a JSON object; every record is one."""
    try:
        record = json.loads(file.read_text())
    except OSError:
        raise RecordsMissing(f"{file}: does not exist") from None
    except json.JSONDecodeError as error:
        raise RecordsMissing(f"{file}:{error.lineno}: not JSON: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        raise RecordsMissing(f"{file}: not JSON: {error}") from None
    need(isinstance(record, dict), f"{file}: expected an object")
    return record


class Cell(str):
    """The text of a cell; float(cell) and int(cell) raise RecordsDamaged if it is no number."""
    place = ""  # file, line and column

    def __float__(self):
        return self._number(float, "a number")

    def __int__(self):
        return self._number(int, "a whole number")

    def _number(self, kind, words):
        try:
            return kind(str(self))
        except ValueError:
            raise RecordsDamaged(f"{self.place} = {self}: expected {words}") from None


class Row(dict):
    """A row of a table: column -> text. A missing column raises RecordsMissing. A row with further cells keeps its
    place."""

    def __init__(self, cells, place):
        super().__init__(cells)
        self.place = place  # file and line

    def __getitem__(self, column):
        cell = super().__getitem__(column)
        if isinstance(cell, str):
            cell = Cell(cell)
            cell.place = f"{self.place}: {column}"
        return cell

    def __missing__(self, column):
        raise RecordsMissing(f"{self.place}: no column {column}")

    def __or__(self, cells):
        return Row({**self, **cells}, self.place)

    def number(self, column):
        """None where the cell is empty."""
        return float(self[column]) if self[column] else None


def read_rows(file):
    """The rows of a CSV file."""
    try:
        with open(file, newline="") as stream:
            reader = csv.DictReader(stream)
            rows = [Row(cells, f"{file}:{reader.line_num}") for cells in reader]
    except OSError:
        raise RecordsMissing(f"{file}: does not exist") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise RecordsDamaged(f"{file}: not a table: {error}") from None
    for row in rows:
        if None in row or None in row.values():  # csv.DictReader has None for a column or a cell of its own making
            raise RecordsDamaged(f"{row.place}: expected {len(reader.fieldnames)} cells, as in the first line")
    return rows


def rows_if_any(file):
    """The rows of a CSV file, or none if it does not exist."""
    return read_rows(file) if file.is_file() else []


def table(file, columns):
    """The rows of a CSV file that must have these columns."""
    rows = read_rows(file)
    need(rows, f"{file}: no rows")
    absent = columns - rows[0].keys()
    if absent:
        raise RecordsMissing(f"{file}: no column {', '.join(sorted(absent))}")
    return rows
