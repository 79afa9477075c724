"""The page of a single run: what it found over its frames, its warnings, the viewer and where its records come from. It holds what the run
was asked for, and nothing else is reported as missing."""
import importlib
import types

import records
from records import shapes
from report import origin, run_figures, run_tables
from report.markup import Markup, element, items
from report.page import navigation, whole, written

moved = {"frames?": shapes.whole, "warnings?": [shapes.text], "bad_frame?": shapes.text,
         "breakdown?": shapes.text, "motion?": {"largest_rotation_deg?": shapes.number, "clip_joints?": shapes.whole,
                                                       "matched_joints?": shapes.whole}}
shape = shapes.run | {"scene": shapes.scene | {"name": shapes.text}, "outcome": moved}
trial = {"summary": shapes.text, "warnings": [shapes.text]}


class RunRecords:
    """The records of one run."""

    def __init__(self, folder):
        self.folder = folder
        self.record = shapes.read(folder / "run.json", shape)
        self.run = records.Run(folder)
        file = folder / "try.json"
        self.trial = shapes.read(file, trial) if file.is_file() else None

    @property
    def name(self):
        """A rigged model is known by its file."""
        model = self.record.get("character", {}).get("model")
        return model["file"] if model else self.record["scene"]["name"]

    def labels(self):
        return [deformer["label"] for deformer in self.record["scene"].get("runs", [])]

    def rows(self, label):
        deformer = next(one for one in self.record["scene"]["runs"] if one["label"] == label)
        return self.run.select(deformer["name"], variant=deformer["variant"])

    def table(self, name):
        """The rows of one of the run's tables; none if the run has not written it."""
        file = self.folder / name
        return records.read_rows(file) if file.is_file() else []


def warnings_of(found):
    outcome = found.record["outcome"]
    warnings = list((found.trial or outcome).get("warnings", []))
    warnings += [text for text in (outcome.get("breakdown"), outcome.get("bad_frame")) if text]
    return warnings


def viewer_of(found):
    """The viewer, and the reason if there is none although frames were written."""
    if not any((found.folder / "frames").glob("*.vtu")):
        return None, []
    try:
        recorded_frames, page_of_viewer = map(importlib.import_module, ("records.recorded_frames", "viewer.page"))
        return Markup(page_of_viewer.fragment_of([recorded_frames.Frames.of_run(found.folder)])), []
    except (ImportError, records.RecordsMissing) as error:
        return None, [f"viewer: {str(error).replace(f'{found.folder}/', '')}"]


def page(folder):
    """The text of the page, and what is missing in it."""
    found = RunRecords(folder)
    warnings = warnings_of(found)
    viewer, missing = viewer_of(found)
    sections = [("summary", "What was found", run_tables.summary(found))]
    sections += [("warnings", "Warnings", items(warnings, "missing"))] if warnings else []
    sections += [("viewer", "Viewer", viewer)] if viewer else []
    sections += [("frames", "Over the frames", run_figures.section(found))]
    for anchor, name, content in (("joints", "Volume at the joints", run_tables.joints(found)),
                                  ("distances", "Distances between the deformers", run_tables.distances(found)),
                                  ("model", "What was taken from the model", run_tables.model(found))):
        sections += [(anchor, name, content)] if content else []
    as_set = types.SimpleNamespace(results=folder, runs={found.name: found.record}, left_out=lambda: [])
    sections.append(("origin", "Where the records come from", origin.section(as_set, with_viewer=viewer is not None)))
    frames = found.record["outcome"].get("frames", 0)
    lead = element("p", f"{found.name}, {frames} frames, moved by {', '.join(found.labels())}.", class_="lead")
    return whole(f"pbskin: {found.name}", lead, [navigation(sections), *written(sections)], "summary"), missing
