"""Records of a study that are refused: those that `reproduce` writes for two runs with one value each, which are then damaged."""
import json

from bad_case import Case
from bad_tets import NOISE

PLAN = {"schema": 1, "extent": "quick", "runs": [{"name": "limb", "cost_s": 1}, {"name": "human", "cost_s": 1}], "left_out": []}
MEASUREMENTS = "claim,quantity,body,value,low,high,unit\nC07,linear_drift,limb,1e-6,1e-6,1e-6,1\nC07,linear_drift,bar,2e-6,2e-6,2e-6,1\n"
RUN = json.dumps({"schema": 3, "provenance": {}})
FILES = {"plan.json": json.dumps(PLAN), "limb/run.json": RUN, "limb/measurements.csv": MEASUREMENTS,
         "human/run.json": RUN, "human/measurements.csv": MEASUREMENTS}


def study(files):
    """Returns a function that makes the folder: name -> text or bytes in DIR/momentum."""
    def make(folder):
        for name, content in files.items():
            path = folder / "momentum" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return make


def plan(**changes):
    return json.dumps(PLAN | changes)


def damaged():
    """(name, file, its content, the message of `--judge`, the message of `report` or None)"""
    table, run = "limb/measurements.csv", "limb/run.json"
    yield "empty_table", table, "", "the file is empty", None
    yield "noise_table", table, NOISE, ":1:1: unexpected quote or zero byte within a field", None
    yield "truncated_table", table, MEASUREMENTS[:70], ":2:5: the file ends within a line", None
    yield "missing_column", table, MEASUREMENTS.replace("value", "worth"), "expected a column value", None
    yield "column_twice", table, MEASUREMENTS.replace("low", "value"), "expected each column once", None
    yield "a_word_for_a_number", table, MEASUREMENTS.replace("2e-6,2e-6", "east,2e-6", 1), ":3:4: value = east: expected a number", None
    yield "too_many_fields", table, MEASUREMENTS.replace("bar", "bar,bar"), ":3:8: 8 fields: expected 7", None
    yield "an_open_quote", table, MEASUREMENTS.replace("bar", '"bar'), ":3:3: a quote is never closed", None
    yield "empty_run", run, "", "no JSON, or cut short", "not JSON"
    yield "noise_run", run, NOISE, "no JSON, or cut short", "not JSON"
    yield "truncated_run", run, RUN[:20], "no JSON, or cut short", "not JSON"
    yield "run_without_a_schema", run, "{}", "schema: missing", None
    yield "run_of_an_older_schema", run, RUN.replace("3", "2"), "schema = 2: expected 3", "schema = 2: expected 3"
    yield "run_that_is_a_list", run, "[]", "schema: missing", "expected an object"
    numbered = json.dumps({"provenance": {"git_revision": 7}})
    yield "revision_that_is_a_number", run, numbered, "schema: missing", "provenance.git_revision = 7: expected a text"
    yield "nested_run", run, "[" * 100000, "no JSON, or cut short", "not JSON"
    yield "empty_plan", "plan.json", "", "no JSON, or cut short", "not JSON"
    yield "noise_plan", "plan.json", NOISE, "no JSON, or cut short", "not JSON"
    yield "plan_without_runs", "plan.json", "{}", ": left_out: missing", ": runs: missing"
    yield "plan_that_is_a_list", "plan.json", "[]", ": left_out: missing", "expected an object"
    yield "runs_that_are_a_number", "plan.json", plan(runs=3), "runs: expected a list", "runs = 3: expected a list"
    yield "run_without_a_name", "plan.json", plan(runs=[{}]), "name: missing", "runs[0].name: missing"
    yield "name_that_is_a_number", "plan.json", plan(runs=[{"name": 3}]), "name: expected a text", "runs[0].name = 3: expected a text"
    yield "left_out_without_a_reason", "plan.json", plan(left_out=[{"scene": "walk"}]), "reason: missing", "left_out[0].reason: missing"


def cases():
    for name, file, content, judged, reported in damaged():
        records = {"records": study(FILES | {file: content})}
        yield Case(f"judge {name}", records, ["reproduce", "--judge", "-o", "records"], (f"records/momentum/{file}", judged))
        if reported is not None:
            yield Case(f"report {name}", records, ["report", "records"], (f"records/momentum/{file}", reported))
    verdicts = {"records": study(FILES | {"../claims.json": json.dumps({"schema": 2, "quantities": {}, "claims": "all hold"})})}
    yield Case("report verdicts that are a text", verdicts, ["report", "records"],
               ('records/claims.json: claims = "all hold": expected a list',))
    yield Case("report of nothing", {}, ["report", "none"], ("none", "no such folder"))
    yield Case("report of a file", {"out": "text"}, ["report", "out"], ("out", "no such folder"))
    yield Case("report of no records", {"out": lambda path: path.mkdir()}, ["report", "out"], ("out", "no records"))
    yield Case("judge nothing", {}, ["reproduce", "--judge", "-o", "none"], ("none", "no records"))
    yield Case("judge records below a file", {"out": "text"}, ["reproduce", "--judge", "-o", "out"], ("out", "no records"))
