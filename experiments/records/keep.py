#!/usr/bin/env python3
"""Keeps what the verdicts rest on: from the records of `pbskin reproduce --full -o DIR` the values by which claims are
judged, those that they show for comparison, the studies' own tables and the provenance, below 8 MB, in
experiments/records/full. Studies that DIR lacks keep their earlier records, with the revision of these. `pbskin
reproduce --judge -o experiments/records/full` judges them all again.

    python3 experiments/records/keep.py results/full [FOLDER]
"""
import csv
import gzip
import io
import json
import pathlib
import re
import shutil
import sys
import tempfile
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "paper_figures"))
from records import kept  # noqa: E402

JUDGED = ["scene", "deformer", "variant", "order", "precision", "iterations", "threads", "frame", "time_s", "angle_deg",
          "outcome", "volume_change_pct", "volume_abs_change_pct", "inverted_tets", "masked_share_pct",
          "error_joint_pct"]
PROVENANCE = ["version", "git_revision", "git_dirty", "compiler", "flags", "build_type", "cpu_model", "logical_cpus"]
DRAWN = ("bones.csv", "bones_rest.csv", "binding.csv", "embedding.csv")  # beside frames, which are not kept
MOST_BYTES = 8_000_000
COMPRESSED_FROM = 1_000_000  # bytes of a table of all runs, which is then NAME.csv.gz
# Tables of a run from which those of the study follow: kept whatever their length. WHOLE: of a study, with all digits,
# since every decision can be recomputed from them.
RAW = ("rates.csv", "played.csv")
WHOLE = ("errors.csv", "pairs.csv")
# Tables that no verdict and no page reads, and rows.csv, whose rows verification.csv has. Three figures need them from
# a run.
UNREAD = ("profiles.csv", "regions.csv", "smoothness.csv", "rows.csv", "towards.csv", "points.csv", "training.csv")
PICTURED = ("nh_p2",)  # the reference in the README's picture of the limb, which no claim selects
PAGES = ("bench.txt",)  # a study's texts that are no pages
TABLE_BYTES = 60_000  # of a run's further tables; longer ones are made again by the run
SUMMARY_BYTES = 200_000  # of a study's own files, which sum up its runs'


number = re.compile(r"[-+]?(\d+\.\d*|\.?\d+)(e[-+]?\d+)?", re.ASCII | re.IGNORECASE)


def rounded(text):
    """Six digits are enough for every bound. Whole numbers and texts stay. 01_01 is the name of a clip, which float()
    reads as 101."""
    return f"{float(text):.6g}" if number.fullmatch(text) and not text.lstrip("-").isdigit() else text


def shown_deformers():
    """Each deformer that claims of the study `volume`, the only one judged from metrics.csv, select -> its numbers of
    iterations; None for any, as where one selection states none."""
    claims = tomllib.loads((pathlib.Path(__file__).resolve().parents[1] / "verdicts"
                            / "claims.toml").read_text(encoding="utf-8"))["claim"]
    selected = [of.get("of", {}) for claim in claims if claim["study"] == "volume"
                for of in (claim, *claim.get("controls", []), *claim.get("compared", []))]
    deformers = {name: None for name in PICTURED}
    for of in (of for of in selected if "deformer" in of):
        known = deformers.setdefault(of["deformer"], set())
        deformers[of["deformer"]] = known | {of["iterations"]} if known is not None and "iterations" in of else None
    return deformers


def is_shown(row, deformers):
    iterations = deformers.get(row["deformer"])
    return row["deformer"] in deformers and (iterations is None or int(float(row["iterations"])) in iterations)


def keep_metrics(source, target):
    """The rows and columns of metrics.csv that claims are judged by, or show for comparison."""
    deformers = shown_deformers()
    with source.open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if is_shown(row, deformers)]
    columns = [column for column in JUDGED if rows and column in rows[0]]
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([rounded(row[column]) for column in columns] for row in rows)


def keep_table(source, target):
    """With rounded numbers."""
    with source.open(newline="", encoding="utf-8") as file, target.open("w", newline="", encoding="utf-8") as kept_file:
        rows = csv.DictReader(file)
        writer = csv.DictWriter(kept_file, rows.fieldnames, lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: rounded(value) for name, value in row.items()} for row in rows)


def keep_run(source, target):
    """Returns the tables that are not kept, relative to the study's folder."""
    too_long = []
    record = json.loads((source / "run.json").read_text(encoding="utf-8"))
    provenance = {key: value for key, value in record.get("provenance", {}).items() if key in PROVENANCE}
    target.mkdir(parents=True)
    (target / "run.json").write_text(json.dumps({"schema": record["schema"], "provenance": provenance},
                                                indent=1) + "\n", encoding="utf-8")
    for table in sorted(source.glob("*.csv")):
        if table.name == "metrics.csv":
            keep_metrics(table, target / table.name)
        elif table.name in DRAWN:
            continue
        elif table.name in ("measurements.csv", "printed.csv"):
            shutil.copyfile(table, target / table.name)
        elif table.name in RAW or (table.stat().st_size <= TABLE_BYTES and table.name not in UNREAD):
            keep_table(table, target / table.name)
        else:
            too_long.append(table.relative_to(source.parent))
    return too_long


def keep_study(source, target):
    """not_kept.csv lists the files that are not kept."""
    target.mkdir(parents=True)
    too_long = []
    for file in sorted(source.iterdir()):
        if file.suffix not in (".csv", ".md", ".json") and file.name not in PAGES:
            continue
        if file.name in ("plan.json", *WHOLE) or file.stat().st_size <= SUMMARY_BYTES:
            shutil.copyfile(file, target / file.name)
        else:
            too_long.append(file.relative_to(source))
    for run in json.loads((source / "plan.json").read_text(encoding="utf-8"))["runs"]:
        if (source / run["name"] / "run.json").exists():
            too_long += keep_run(source / run["name"], target / run["name"])
    if too_long:
        lines = [f"{file.parent if file.parent.name else ''},{file.name},{(source / file).stat().st_size}\n"
                 for file in too_long]
        (target / "not_kept.csv").write_text("run,file,bytes\n" + "".join(lines), encoding="utf-8")


def joined(tables, column):
    """The rows of several tables, (value, file), as one with a column in front. A table that lacks a column has empty
    cells in it, and one without rows has a row without cells."""
    columns, rows = [], []
    for value, file in tables:
        with file.open(newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            for place, name in enumerate(reader.fieldnames):
                if name not in columns:
                    columns.insert(columns.index(reader.fieldnames[place - 1]) + 1 if place else 0, name)
            rows += [{column: value} | row for row in reader] or [{column: value}]
    text = io.StringIO()
    writer = csv.DictWriter(text, [column, *columns], restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def earlier_studies(kept_records, new, scratch):
    """Writes the kept records of all studies that are not among the new ones, a folder per run, into scratch."""
    if not (kept_records / "provenance.json").is_file():
        return
    expanded = scratch / "earlier"
    kept.expand(kept_records, expanded)
    for folder in expanded.iterdir():
        if folder.is_dir() and folder.name not in new:
            folder.rename(scratch / folder.name)
    shutil.rmtree(expanded)


def concluded_later(kept_records, new):
    """Studies whose conclusions follow from kept rows at a later revision than that which measured them, until they are
    measured anew."""
    file = kept_records / "provenance.json"
    concluded = json.loads(file.read_text(encoding="utf-8")).get("concluded_again", []) if file.is_file() else []
    return [of for of in concluded if of["study"] not in new]


def merge(results, target, concluded_again):
    """From a folder per run to one table per study and kind (paper_figures/records/kept.py reads it)."""
    origins, plans, tables = {}, {}, {}
    for file in sorted(results.rglob("*")):
        study, *rest = place = file.relative_to(results).parts
        if file.is_dir():
            continue
        if file.name == "run.json":
            origins.setdefault(file.read_text(encoding="utf-8"), []).append(f"{study}/{rest[0]}")
        elif file.name == "plan.json":
            plans[study] = json.loads(file.read_text(encoding="utf-8"))
        elif len(rest) == 1 and file.name in ("costs.csv", "not_kept.csv"):
            tables.setdefault((file.name, "study"), []).append((study, file))
        elif len(rest) == 2:
            tables.setdefault((f"{study}/runs/{file.name}", "run"), []).append((rest[0], file))
        else:
            (target / pathlib.Path(*place)).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, target / pathlib.Path(*place))
    for (name, column), parts in tables.items():
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        text = joined(parts, column).encode()
        if len(text) < COMPRESSED_FROM:
            (target / name).write_bytes(text)
        else:
            (target / f"{name}.gz").write_bytes(gzip.compress(text, 9, mtime=0))
    measured = [json.loads(text) | {"runs": runs} for text, runs in origins.items()]
    for name, content in (("plans.json", plans),
                          ("provenance.json", {"origins": measured, "concluded_again": concluded_again})):
        (target / name).write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def keep(results, target):
    """Into a folder beside, which takes the old one's place when it is whole and small enough."""
    plans = sorted(results.glob("*/plan.json"))
    if not plans:
        sys.exit(f"keep: {results}: no records of a study")
    beside = target.with_name(target.name + ".new")
    shutil.rmtree(beside, ignore_errors=True)
    beside.mkdir(parents=True)
    with tempfile.TemporaryDirectory() as scratch:
        new = {plan.parent.name for plan in plans} - {"frames"}  # no claim is judged by them
        earlier_studies(target, new, pathlib.Path(scratch))
        for study in sorted(new):
            keep_study(results / study, pathlib.Path(scratch) / study)
        # claims.json is longer, and --judge writes it again.
        shutil.copyfile(results / "claims.md", pathlib.Path(scratch) / "claims.md")
        merge(pathlib.Path(scratch), beside, concluded_later(target, new))
    size = sum(file.stat().st_size for file in beside.rglob("*") if file.is_file())
    if size > MOST_BYTES:
        sys.exit(f"keep: {size / 1e6:.2f} MB in {beside}, more than {MOST_BYTES / 1e6:g}")
    shutil.rmtree(target, ignore_errors=True)
    beside.rename(target)
    print(f"{size / 1e6:.2f} MB in {target}")
    for table in sorted(target.rglob("*.csv")):
        if "not installed" in table.read_text(encoding="utf-8"):
            print(f"keep: warning: {table}: a program that a run needs was not installed", file=sys.stderr)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    keep(pathlib.Path(sys.argv[1]),
         pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).resolve().parent / "full")
