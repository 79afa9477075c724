"""How many pairs of deformers are decided, which are not and why, which references decide nothing, and the parts of PBS's error."""
import collections

import pages
import records
from words import looks


def pose(row):
    return row["pose"] or f"{float(row['angle_deg']):g}\u00b0"


def decided(pairs):
    return f"{sum(pair['decision'] == 'decided' for pair in pairs)} of {len(pairs)}"


def of_pairs(pairs):
    notable = [pair for pair in pairs if float(pair["largest_difference_pct"]) > records.notable_points]
    skinning = [pair for pair in notable if "fem_linear" not in (pair["first"], pair["second"])]
    text = (f"{decided(notable)} pairs of deformers whose errors differ by more than {records.notable_points} percentage points are "
            f"decided. Without linear finite elements, these are {decided(skinning)} pairs.\n")
    undecided = [pair for pair in notable if pair["decision"] != "decided"]
    first, second = (lambda row, name=name: looks.of(row[name]).name for name in ("first", "second"))
    return text + ("\n" + pages.table(undecided, "undecided", pose=pose, first=first, second=second) if undecided else "")


def of_members(members):
    reached = [row for row in members if row["outcome"] == "reached"]
    unbounded = sum(not row["error_bound_pct"] for row in reached)
    text = (f"{len(reached)} of {len(members)} references were reached. {unbounded} of these have no bound on their own error and decide "
            "nothing, because too few of their solutions converged.\n")
    silent = [row for row in members if row["outcome"] != "reached" or not row["error_bound_pct"]]
    if silent:
        text += ("\nThe worst tet is that with the smallest volume ratio, in the reference or in the finest solution if none was "
                 "reached.\n\n" + pages.table(silent, "silent", pose=pose))
    minutes = collections.Counter()
    for row in members:
        minutes[(row["body"], row["motion"], pose(row))] += float(row["solve_s"]) / 60.0
    return text + "\n## Wall time of all references of a pose\n\n" + pages.table(
        [{"body": body, "motion": motion, "pose": of, "minutes": spent} for (body, motion, of), spent in minutes.items()], "minutes")


def of_shares(folder):
    """The share of the error of LBS that each deformer removes: by the first reference, and the least and the most of all references."""
    poses = collections.defaultdict(list)
    for row in pages.of_runs(folder, "errors.csv", {"member", "deformer", "error_joint_pct"}):
        poses[row["body"], row["motion"], pose(row)].append(row)
    rows = []
    for (body, motion, of), errors in poses.items():
        by_first = [row for row in errors if row["member"] == records.first_member]
        first = records.removed_shares(by_first)
        shares = {name: f"{round(first[name][0]) if name in first else 'not reached'} ({round(min(of_all))} to {round(max(of_all))})"
                  for name, of_all in records.removed_shares(errors).items()}
        in_mm = {row["deformer"]: f"{float(row['skin_rms_mm']):.0f}" for row in by_first if row.get("skin_rms_mm")}
        in_words = " / ".join(in_mm[name] for name in ("lbs", "pbs") if in_mm)
        rows.append({"body": body, "motion": motion, "pose": of, "mm": in_words, **shares})
    columns = {"body": "body", "motion": "motion", "pose": "pose"}
    columns |= {looks.of(name).name: name for name in looks.in_order({name for row in rows for name in row} - {*columns, "mm"})}
    if any(row["mm"] for row in rows):
        columns["skin of LBS / PBS from the first reference, body of 1.7 m [mm]"] = "mm"
    return ("\n## The share of the error of LBS that is removed [%]\n\nAt the joints: by the first reference, and in brackets the range "
            "over all references. It is negative where LBS is closer.\n\n" + pages.table(rows, columns))


def of_parts(folder):
    """The parts after the paper's 24 iterations, and the distance of PBS from flesh that the bind constraint holds."""
    parts = [row for row in pages.of_runs(folder, "parts.csv", {"iterations", "k_stretch"}) if row["iterations"] == "24"]
    if not parts:
        return ""
    key = ("body", "motion", "pose", "angle_deg", "k_stretch")
    bound = {tuple(row[name] for name in key): row["model_pct"]
             for row in pages.of_runs(folder, "attachments.csv", {"attachment", "model_pct"}) if row["attachment"] == "bind"}
    rows = [row | {"bind_pct": bound.get(tuple(row[name] for name in key), "")} for row in parts]
    return "\n## The error of PBS after 24 iterations [% of the bone distance]\n\n" + pages.table(rows, "parts", pose=pose)


def page(folder):
    members = records.table(folder / "members.csv", {"member", "outcome", "error_bound_pct", "solve_s"})
    pairs = records.table(folder / "pairs.csv", {"first", "second", "largest_difference_pct", "decision"})
    return ("# Which deformer is closer, whatever reference is taken\n\n" + of_pairs(pairs) + of_shares(folder) + "\n## The references\n\n"
            + of_members(members) + of_parts(folder))
