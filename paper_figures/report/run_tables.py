"""The tables of a run's page."""
import math
import statistics

from drawing import style
from report.markup import details, element, items, joined, table
from report.record_set import number
from words import looks
from words.number_words import counted, figure, listed, span_of_thousandths


def known(rows, column):
    """The finite numbers of a column; none if the run has no such column."""
    return [value for value in (number(row, column) for row in rows) if value is not None and math.isfinite(value)]


def median(values):
    return figure(statistics.median(values)) if values else figure(None)


def of_deformer(found, label):
    rows = found.rows(label)
    change, error, step = (known(rows, column) for column in ("volume_change_pct", "error_joint_pct", "step_ms"))
    inverted = known(rows, "inverted_tets")
    is_reference = label == found.record["scene"].get("reference", {}).get("name")
    told_error = "the reference" if is_reference else f"{figure(statistics.median(error))} ({figure(max(error))})" if error else "\u2013"
    return [looks.of(label).name, span_of_thousandths(change), f"{max(inverted, default=0):.0f}", told_error, median(step)]


def summary(found):
    """The sentence of `pbskin try`, if it made the run, and one row per deformer."""
    sentence = element("p", found.trial["summary"], class_="answer") if found.trial else ""
    header = ["deformer", "volume change [%]", "most inverted tets in a frame", "error at the joints [%]: median (largest)",
              "median step [ms]"]
    rows = [of_deformer(found, label) for label in found.labels()]
    return joined([sentence, table("Over all frames", header, rows)], "\n")


def joints(found):
    """The mean change of the volume at each joint, in per cent of the joint's own volume."""
    rows = [row for row in found.table("regions.csv") if row["kind"] == "joint"]
    changes = {}
    for row in rows:
        changes.setdefault(f"{row['bone']} \u2013 {row['second_bone']}", {})[row["deformer"]] = number(row, "own_change_pct")
    if not changes:
        return ""
    labels = [label for label in found.labels() if any(label in of for of in changes.values())]
    first = labels[0]
    ordered = sorted(changes.items(), key=lambda pair: pair[1].get(first) or 0.0)
    body = [[name, *(figure(of.get(label)) for label in labels)] for name, of in ordered]
    return table("Mean change of the volume of the tets at a joint [% of their volume at rest]",
                 ["joint", *(looks.of(label).name for label in labels)], body, "tall")


def distances(found):
    """The distances between the surfaces of each pair of deformers over the written frames."""
    pairs = {}
    for row in found.table("distances.csv"):
        pairs.setdefault((row["deformer"], row["other"], row["of"]), []).append((number(row, "rms_mm"), number(row, "largest_mm")))
    if not pairs:
        return ""
    body = [[f"{one} and {other}", of, figure(statistics.median(rms for rms, _ in values)), figure(max(largest for _, largest in values)),
             len(values)] for (one, other, of), values in pairs.items()]
    return table("Distances between the same points", ["deformers", "of", "median rms [mm]", "largest [mm]", "frames"], body, "tall")


def model(found):
    """What the run took from a rigged model; nothing for other characters."""
    record = found.record.get("character", {}).get("model")
    if not record:
        return ""
    dropped = [f"{joint['name']} ({joint['reason']})" for joint in record["joints_dropped"]]
    motion = found.record["outcome"].get("motion", {})
    matched = f"{motion['matched_joints']} of the clip's {motion['clip_joints']} moving joints match" if "clip_joints" in motion else ""
    facts = [f"File: {record['file']}; {counted(len(record['meshes']), 'mesh', 'meshes')}: {listed(record['meshes'])}.",
            f"Largest extent: {figure(record['extent_m'])} m, with {figure(record['metres_per_unit'])} m per unit of the file.",
            f"Joints dropped: {listed(dropped)}.", f"Containers, which only contribute their transform: {listed(record['containers'])}.",
            f"From the bind pose to the file's rest pose, bones turn by up to {figure(record['bind_pose_deg'])}\u00b0.",
            f"Animations: {listed(record['animations'])}."]
    if "weights_transferred_pct" in record:
        facts.append(f"The tets carry {figure(record['weights_transferred_pct'])} % of the artist's weights.")
    facts += [matched + "."] if matched else []
    return joined([items(facts), details(f"{counted(len(record['joints']), 'joint')} that are bones", items(record["joints"]))], "\n")
