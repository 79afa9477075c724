"""The contents of a folder of records: the verdicts, the origin of each run and its cost. Nothing is computed beyond
the records.

    found = record_set.RecordSet(results)
    for claim in found.claims: ...
"""
import records
from records import kept, shapes
from words import sentences


class RecordSet:
    def __init__(self, results):
        records.need(results.is_dir(), f"{results}: no such folder")
        self.results = results
        self.runs = {file.parent.relative_to(results).as_posix(): shapes.read(file, shapes.run)
                     for file in self.files("**/run.json")}
        records.need(self.runs, f"{results}: no records: no run.json in it or below; run `pbskin reproduce -o` into "
                                "it first")
        self.studies = sorted({name.split("/")[0] for name in self.runs})
        self.plans = {file.parent.name: shapes.read(file, shapes.plan) for file in self.files("*/plan.json")}
        judged = results / "claims.json"
        self.claims = sentences.claims_of(judged) if judged.is_file() else None  # None if no claim was judged
        file = results / "repeated.json"
        self.repeated = shapes.read(file, shapes.repeated) if file.is_file() else {"text": "", "claims": {}}
        self.judging = kept.record_behind(results) or results  # the records that verdicts and answers rest on

    def run(self, name, shape):
        """The record of a run of which further members are read."""
        shapes.check(self.results / name / "run.json", self.runs[name], shape)
        return self.runs[name]

    def rows(self, name):
        """The rows of a CSV file, or none if it does not exist."""
        return records.rows_if_any(self.results / name)

    def files(self, pattern):
        return sorted(self.results.glob(pattern))

    def left_out(self):
        """(study, scene, reason) for each scene that could not run on that machine."""
        return [(study, left["scene"], left["reason"]) for study, plan in self.plans.items()
                for left in plan.get("left_out", [])]


def not_run(found, study):
    """The reason why a part of the page is missing."""
    return f"not on record: {why_absent(found, study)} (pbskin reproduce {study})"


def why_absent(found, study):
    if study in found.studies:
        return f"the runs of the study {study} have none of it"
    return (f"the study {study} was started and has not ended" if (found.results / study).is_dir()
            else f"the study {study} was not run")


def number(row, column):
    """None if the cell is empty or its column is missing, as in records of an earlier version."""
    return row.number(column) if column in row else None
