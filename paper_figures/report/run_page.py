"""The page of a single run: what it found over its frames, its warnings, the viewer and where its records come from. It
holds what the run was asked for. What is missing is the viewer, if no frames were written or they cannot be shown."""
import importlib
import math
import pathlib
import re
import statistics
import tempfile
import types

import records
from drawing import style
from records import shapes
from report import answers, origin
from report.figures import inline_svg
from report.markup import Markup, details, element, inline, items, joined, table
from report.page import glossary_section, navigation, whole, written
from report.record_set import number
from words import looks, methods_of_run
from words.number_words import counted, figure, listed, span_of_thousandths

moved = {"frames?": shapes.whole, "warnings?": [shapes.text], "notes?": [shapes.text], "bad_frame?": shapes.text,
         "breakdown?": shapes.text,
         "from_artist?": {"largest_pct": shapes.number, "frame": shapes.whole},
         "motion?": {"largest_rotation_deg?": shapes.number, "clip_joints?": shapes.whole,
                     "matched_joints?": shapes.whole,
                     "stretched_bones?": [{"bone": shapes.text, "change_pct": shapes.number, "frame": shapes.whole}]}}
shape = shapes.run | {"scene": shapes.scene | {"name": shapes.text}, "outcome": moved}
MODEL = 'id="viewer-block"'  # of the element of the page that has what the viewer shows
animation = {"name": shapes.text, "duration_s": shapes.number, "largest_rotation_deg": shapes.number}
ranking = {"place": shapes.one_of("joints", "body"), "methods": [{"deformer": shapes.text, "median_pct": shapes.number,
                                                                   "nearest_in": shapes.whole}]}
trial = {"summary": shapes.text, "nearest_sentence?": shapes.text, "doubtful_reference?": shapes.text_or_none,
         "inverting?": {"*": {"is_excluded?": shapes.truth}}, "nearest?": lambda value: shapes.anything if value is None
         else ranking,
         "warnings": [shapes.text], "notes?": [shapes.text], "animations?": [animation]}


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

    def judges_volume(self):
        """Not where bones move away from their parents, for the artist changes the volume there. A warning says so."""
        return not self.record["outcome"].get("motion", {}).get("stretched_bones")

    def labels(self):
        return [deformer["label"] for deformer in self.record["scene"].get("runs", [])
                if self.run.has(deformer["name"], deformer["variant"])]

    def rows(self, label):
        deformer = next(one for one in self.record["scene"]["runs"] if one["label"] == label)
        return self.run.select(deformer["name"], variant=deformer["variant"])

    def table(self, name):
        """The rows of one of the run's tables; none if the run has not written it."""
        return records.rows_if_any(self.folder / name)


# The tables.

def known(rows, column):
    """The finite numbers of a column; none if the run has no such column."""
    return [value for value in (number(row, column) for row in rows) if value is not None and math.isfinite(value)]


def place_of_errors(found):
    """The column of the errors, and where they are measured: over the body where no joint has one. None for a run
    without errors."""
    nearest = (found.trial or {}).get("nearest") or {}
    places = {"joints": ("error_joint_pct", "at the joints"), "body": ("error_l2_pct", "over the body")}
    return next((place for name, place in places.items() if nearest.get("place", name) == name
                 and known(found.run.rows, place[0])), None)


def errors_of(found):
    """label -> its errors [%] by frame; a reference has none."""
    reference = found.record["scene"].get("reference", {}).get("name")
    column, _ = place_of_errors(found) or ("error_joint_pct", "")
    errors = {label: {row["frame"]: number(row, column) for row in found.rows(label)} for label in found.labels()}
    return {label: {frame: error for frame, error in of.items() if error is not None and math.isfinite(error)}
            for label, of in errors.items() if label != reference}


# An error below it is no difference between two methods, as in experiments/trial/trial_facts.cpp.
least_visible_pct = 0.01


def compared_frames(errors):
    """The frames in which all methods have an error that is seen: a method that fails in the hard ones would look best
    by the others."""
    of_frames = {frame: [of[frame] for of in errors.values() if frame in of] for frame in set().union(*errors.values())}
    seen = {frame: len(of) for frame, of in of_frames.items() if max(of) >= least_visible_pct}
    most = max(seen.values(), default=0)
    return {frame for frame, count in seen.items() if count == most}


def excluded(found):
    """The deformers that a trial has excluded for their inverted tets."""
    return {label for label, of in (found.trial or {}).get("inverting", {}).items() if of.get("is_excluded", True)}


def methods_of(found):
    """What the first card has of each deformer, the nearest one first and the reference last; without errors in their
    own order. A trial has ranked its methods."""
    errors, methods, not_compared = errors_of(found), [], excluded(found)
    frames = compared_frames(errors)
    ranked = {of["deformer"]: of for of in ((found.trial or {}).get("nearest") or {}).get("methods", ())}
    compared = {label: of for label, of in errors.items() if label not in not_compared}
    nearest = [min((of[frame], label) for label, of in compared.items() if frame in of)[1] for frame in frames
               if any(frame in of for of in compared.values())]
    for label in found.labels():
        rows, own = found.rows(label), [error for frame, error in errors.get(label, {}).items() if frame in frames]
        change, step = (known(rows, column) for column in ("volume_change_pct", "step_ms"))
        rank = ranked.get(label, {"median_pct": statistics.median(own) if own else None,
                                  "nearest_in": nearest.count(label)})
        methods.append({"label": label, "name": looks.of(label).name, "is_reference": label not in errors,
                        "change": span_of_thousandths(change), "is_compared": label not in not_compared,
                        "volume_pct": max(change, key=abs, default=None) if found.judges_volume() else None,
                        "inverted": max(known(rows, "inverted_tets"), default=0), "error_pct": rank["median_pct"],
                        "largest_pct": max(own, default=None), "step_ms": statistics.median(step) if step else None,
                        "nearest_in": rank["nearest_in"]})
    return sorted(methods,
                  key=lambda of: (of["is_reference"], math.inf if of["error_pct"] is None else of["error_pct"]))


def lines(found):
    """The three lines of the first screen: what changes, how far it is from simulated flesh, and what it costs. They
    compare PBS and LBS, or the first two deformers of a run without both."""
    usual = [label for label in ("pbs", "lbs") if label in found.labels()]
    of = {looks.of(label).name: found.rows(label) for label in (usual if len(usual) == 2 else found.labels()[:2])}

    def each(text, column, number_of):
        """The numbers of the deformers whose rows have the column: 1.2 ms with PBS and 0.03 ms with LBS."""
        values = {name: known(rows, column) for name, rows in of.items()}
        return " and ".join(text.format(number_of(those), name) for name, those in values.items() if those)

    def rms(values):
        return figure(math.sqrt(statistics.fmean(value * value for value in values)))

    volume = each("{} % with {}", "volume_change_pct", span_of_thousandths) if found.judges_volume() else ""
    changed = f"The volume changes by {volume}." if volume else "No volume is known." if found.judges_volume() else (
        "Joints move apart, so that volume is not judged.")
    away = each("{} mm with {}", "skin_rms_mm", rms) if place_of_errors(found) else ""
    far = f"The skin is {away} from the finite elements (rms over skin and frames, on a body of 1.7 m)." if away else ""
    cost = each("{} ms with {}", "step_ms", lambda values: figure(statistics.median(values)))
    if found.trial:  # the first card has the first sentences
        changed = found.trial["summary"].removeprefix(found.trial.get("nearest_sentence", ""))
    return [answers.answer("What changes?", changed),
            answers.answer("How far from simulated flesh?", far or "No distance from finite elements is known."),
            answers.answer("At what cost?", f"A frame takes {cost} (median)." if cost else "No time is known.")]


def summary(found):
    """The first card: the nearest method in one sentence, and one row per method."""
    methods, errors, volume = methods_of(found), place_of_errors(found), found.judges_volume()
    header = ["method", *(["error [%]"] if errors else []), *(["volume [%]"] if volume else []), "ms per frame",
              "inverted tets"]

    def row(of):
        error = "the reference" if of["is_reference"] else (
            "\u2013" if of["error_pct"] is None else f"{figure(of['error_pct'])} ({figure(of['largest_pct'])})")
        name = "FEM" if of["is_reference"] else of["name"]
        shown = [*([error] if errors else []), *([of["change"]] if volume else [])]
        return [name, *shown, figure(of["step_ms"]), f"{of['inverted']:.0f}"]

    of_trial = (found.trial or {}).get("nearest_sentence")
    sentence = methods_of_run.nearest_method(methods) if of_trial is None else of_trial
    shown = [element("p", f"{sentence[:1].upper()}{sentence[1:]}")] if sentence else []
    notes = [*([f"Error {errors[1]}: its median and, in brackets, its largest value."] if errors else []),
             *(["Volume: the range of its change."] if volume else []), "Time: the median.",
             "Inverted tets: the most in a frame."]
    note = element("p", " ".join(notes), class_="under")
    return answers.card("summary", "Which method is nearest?" if errors and sentence else "The methods",
                        [*shown, table("Over all frames", header, map(row, methods)), note])


def joints(found):
    """The mean change of the volume at each joint, and where other bones meet, in per cent of the volume there. A run
    without the table of bones does not state which pairs are bone and parent: all are taken for joints."""
    parents = {row["bone"]: row["parent"] for row in found.table("bones_rest.csv")}
    at_joints, at_others = {}, {}
    for row in found.table("regions.csv"):
        one, other = row["bone"], row["second_bone"]
        if row["kind"] == "joint":
            of = at_joints if not parents or parents.get(other) == one or parents.get(one) == other else at_others
            of.setdefault(f"{one} \u2013 {other}", {})[row["deformer"]] = number(row, "own_change_pct")
    tables = volume_table(found, at_joints, "at a joint", "joint"), volume_table(found, at_others,
                                                                                 "where two bones meet", "bones")
    return joined(filter(None, tables), "\n")


def volume_table(found, changes, where, what):
    labels = [label for label in found.labels() if any(label in of for of in changes.values())]
    if not labels:
        return ""
    ordered = sorted(changes.items(), key=lambda pair: pair[1].get(labels[0]) or 0.0)
    body = [[name, *(figure(of.get(label)) for label in labels)] for name, of in ordered]
    return table(f"Mean change of the volume of the tets {where} [% of their volume at rest]",
                 [what, *(looks.of(label).name for label in labels)], body, "tall")


def distances(found):
    """The distances between the surfaces of each pair of deformers over the written frames."""
    pairs = {}
    for row in found.table("distances.csv"):
        pairs.setdefault((row["deformer"], row["other"], row["of"]),
                         []).append((number(row, "rms_mm"), number(row, "largest_mm")))
    if not pairs:
        return ""
    body = [[f"{looks.of(one).name} and {looks.of(other).name}", of,
             figure(statistics.median(rms for rms, _ in values)), figure(max(largest for _, largest in values)),
             len(values)] for (one, other, of), values in pairs.items()]
    return table("Distances between the same points of two deformers, at the size of this body",
                 ["deformers", "of", "median rms [mm]", "largest [mm]", "frames"], body, "tall")


# Sentences about the rigged model of a run. The page shows a sentence if the record has a value for each name in
# braces.
of_model = ("File: {file}; {meshes_in_file}: {meshes}.", "Largest extent: {extent_m} m, with {metres_per_unit} m per "
                                                         "unit of the file.",
            "Joints dropped: {dropped}.", "Containers, which only contribute their transform: {containers}.",
            "From the bind pose to the file's rest pose, bones turn by up to {bind_pose_deg}\u00b0.",
            "Animations: {animations}.", "The tets carry {weights_transferred_pct} % of the artist's weights.",
            "Bones whose distance from their parent changes by more than 10 %: {stretched}.",
            "The surface that LBS carries with the tets is up to {largest_pct} % of the model's size from the "
            "artist's, in frame {frame}.",
            "{matched_joints} of the clip's {clip_joints} moving joints match, without fingers and the like.")
animation_columns = ["animation", "duration [s]", "largest rotation of a joint [degrees]", "shown here"]


def model(found):
    """What the run took from a rigged model; nothing for other characters."""
    record, outcome = found.record.get("character", {}).get("model"), found.record["outcome"]
    if not record:
        return ""
    values = record | outcome.get("motion", {}) | outcome.get("from_artist", {})
    values["dropped"] = [f"{joint['name']} ({joint['reason']})" for joint in values.pop("joints_dropped")]
    if bones := values.pop("stretched_bones", None):
        values["stretched"] = [f"{of['bone']} by {of['change_pct']:+.0f} % in frame {of['frame']}" for of in bones]
    values["meshes_in_file"] = counted(len(record["meshes"]), "mesh", "meshes")
    played = None if "clip_joints" in values else record.get("animation")
    rows = [[one["name"], figure(one["duration_s"]), figure(one["largest_rotation_deg"]),
             "yes" if one["name"] == played else ""]
            for one in (found.trial or {}).get("animations", [])]
    if rows:
        del values["animations"]
    words = {name: listed(value) if isinstance(value, list) else figure(value) if isinstance(value, float) else value
             for name, value in values.items()}
    facts = [text.format(**words) for text in of_model if words.keys() >= set(re.findall(r"\{(\w+)\}", text))]
    animations = table("Animations of the model; --animation NAME takes another one", animation_columns, rows,
                       "tall") if rows else ""
    bones = details(f"{counted(len(record['joints']), 'joint')} that are bones", items(record["joints"]))
    return joined([items(facts), animations, bones], "\n")


# The figures: the numbers over the frames, and error against run time.

def abscissa(rows):
    """Angles of a sweep, or times."""
    angles = [number(row, "angle_deg") for row in rows]
    if all(angle is not None for angle in angles):
        return angles, "angle [degrees]"
    return [number(row, "time_s") for row in rows], "time [s]"


def over_frames(found):
    rows = {label: found.rows(label) for label in found.labels()}
    column, where = place_of_errors(found) or ("error_joint_pct", "at the joints")
    measures = [*([("volume_change_pct", "volume change [%]")] if found.judges_volume() else []),
                (column, f"error {where} [%]"), ("inverted_tets", "inverted tets")]
    shown = [(column, name) for column, name in measures if any(value for of in rows.values()
                                                                for value in known(of, column))]
    shown = shown or measures[:1]
    figure, axes = style.panels(len(shown), 1, height_in=1.7, sharex=True)
    for panel, (column, name) in zip(axes[:, 0], shown):
        for label, of in rows.items():
            x, unit = abscissa(of)
            y = [next(iter(known([row], column)), math.nan) for row in of]
            # Between two frames without a value, as where the reference was not solved, a point has no line and is seen
            # by its marker.
            marked = 1 if any(map(math.isnan, y)) else max(1, len(y) // 9)
            panel.plot(x, y, **style.as_of(label, markevery=marked))
        panel.set_ylabel(name)
        panel.margins(x=0)
    axes[-1][0].set_xlabel(unit)
    style.key_below(figure)
    return figure


def error_against_time(methods, where):
    """One point per method that has an error and a time; None without any."""
    points = [of for of in methods if not of["is_reference"] and of["error_pct"] is not None
              and of["step_ms"] is not None]
    if not points:
        return None
    figure, axes = style.panels(1, 1, height_in=2.6)
    for of in points:
        axes[0][0].plot([of["step_ms"]], [of["error_pct"]], **style.as_of(of["label"], linestyle="none", markersize=6))
    style.decades(axes[0][0].xaxis)
    axes[0][0].set(xlabel="median time of a step [ms]", ylabel=f"median error {where} [%]")
    axes[0][0].set_ylim(bottom=0)
    style.key_below(figure)
    return figure


def drawn(found, name, figure, title, caption):
    origin = records.origin_of({found.name: found.record})
    with tempfile.TemporaryDirectory() as folder:
        stem = pathlib.Path(folder) / name
        style.save(figure, stem, origin, [{"figure": name}], formats=("svg",))
        text = stem.with_suffix(".svg").read_text()
    title = f"{title[:1].upper()}{title[1:]}"
    said = element("figcaption", joined([element("b", f"{title}. "), caption]))
    return element("figure", joined([inline_svg(text, name, f"{title}. {caption}"), said], "\n"), id=f"figure-{name}")


def figures_section(found):
    methods = [of for of in methods_of(found) if not of["is_reference"]]
    caption = "The numbers of metrics.csv over the frames."
    title = (methods_of_run.largest_change(methods) if found.judges_volume() else "Errors and inverted tets over "
                                                                                  "the frames")
    parts = [drawn(found, "over-frames", over_frames(found), title, caption)]
    _, where = place_of_errors(found) or (None, "")
    against_time = error_against_time(methods, where)
    if against_time:
        is_doubtful = (found.trial or {}).get("doubtful_reference")
        title = "" if is_doubtful else methods_of_run.error_and_time(methods)
        caption = f"The median over the frames of the error {where} and of the time of a step."
        parts.append(drawn(found, "error-against-time", against_time, title or "Error and time of each method",
                           caption))
    told = element("p", "Values are shown next to the pointer or the finger.")
    return joined([told, element("div", joined(parts, "\n"), class_="figures")], "\n")


def viewer_of(found):
    """The viewer, and what is missing of it. A trial removes its frames after it has made its page; then the viewer of
    that page is kept, or what it would show if its program were built."""
    kept = None
    if not any((found.folder / "frames").glob("*.vtu")):
        page = found.folder / "report.html"
        viewer = rf'<div id="frame-viewer">.*?{MODEL}>.*?</script>(\s*<script type="module">.*?</script>)?'
        kept = page.is_file() and re.search(viewer, page.read_text(), re.DOTALL)
        if not kept:
            return None, ["viewer: frames/*.vtu: do not exist: `pbskin try --paraview` keeps them" if found.trial else
                          "viewer: no frames/*.vtu; run the scene again with `--set output.frames_every=1`"]
        if kept[1]:
            return Markup(kept[0]), []
    data = kept[0] if kept else None
    try:
        recorded_frames, page_of_viewer = map(importlib.import_module, ("records.recorded_frames", "viewer.page"))
        data = data or page_of_viewer.data_of([recorded_frames.Frames(found.folder)])
        return Markup(f"{data}\n{page_of_viewer.program()}"), []
    except (ImportError, records.RecordsMissing) as error:
        remedy = "; then `pbskin report` adds it to this page" if data else ""
        return data and Markup(data), [f"viewer: {str(error).replace(f'{found.folder}/', '')}{remedy}"]


def page(folder):
    """The text of the page, and what is missing in it."""
    found = RunRecords(folder)
    outcome = found.record["outcome"]
    remarks = found.trial or outcome
    warnings = [*filter(None, (outcome.get("breakdown"), outcome.get("bad_frame"))), *remarks.get("warnings", [])]
    viewer, missing = viewer_of(found)
    unseen = joined(element("p", inline(f"The moving model is missing: {reason}."), class_="missing")
                    for reason in missing)
    as_set = types.SimpleNamespace(results=folder, runs={found.name: found.record}, left_out=lambda: [])
    first = [summary(found), answers.first_screen(joined(filter(None, (viewer, unseen)), "\n"), lines(found))]
    sections = [("warnings", "Warnings", items(warnings, "missing") if warnings else ""),
                ("notes", "Notes", items(remarks["notes"]) if remarks.get("notes") else ""),
                ("frames", "Over the frames", figures_section(found)),
                ("joints", "Volume at the joints", joints(found) if found.judges_volume() else ""),
                ("distances", "Distances between the deformers", distances(found)),
                ("model", "What was taken from the model", model(found)),
                ("glossary", "Glossary", glossary_section()),
                ("origin", "Where the records come from", origin.section(as_set, with_viewer=not missing))]
    sections = [section for section in sections if section[-1]]
    names = [looks.of(label).name for label in found.labels()]
    lead = element("p", f"{found.name}, {outcome.get('frames', 0)} frames, moved by {listed(names)}.", class_="lead")
    return whole(f"pbskin: {found.name}", lead, [*first, navigation(sections), *written(sections)], "summary"), missing
