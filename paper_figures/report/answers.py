"""The first screen: which claims hold, where the others fail, the distance from the finite elements, and the cost. Every sentence is
composed from claims.json, work_precision/*/points.csv, timing/timing.csv and the studies' costs."""
from records import shapes
from report import origin, verdicts
from report.markup import Markup, element, items, joined, table
from report.record_set import not_run, number
from report.verdicts import mark_of
from words import case_words, sentences
from words.number_words import counted, figure, span

who = ("Each entry states how many of a claim\u2019s units hold and their numbers. A unit is a body with a clip, a joint or a mesh; "
       "brackets are the interval of the share.")
failing = ("fails", "mixed", "inconsistent_in_print", "not_testable", "not_computable")


def do_they_hold(found):
    if not found.claims:
        return element("p", "No verdict is on record: run `pbskin reproduce`, or `pbskin reproduce --judge` on these records.",
                       class_="missing")
    return joined([element("p", sentences.counts(found.claims), class_="answer"), verdicts.chips(found.claims)])


def entry(claim):
    """Mark, claim and statement; then the name of the verdict and the numbers behind it."""
    symbol, colour, name = mark_of(claim["verdict"])
    link = element("a", claim["id"], href=f"#{claim['id']}")
    sign = Markup(f'<span class="{colour}" aria-hidden="true">{symbol}</span>')
    statement = element("span", claim["statement"].replace("k_stretch", "k_stretch (how stiff edges are, 0 to 1)"), class_="statement")
    verdict = element("b", name[:1].upper() + name[1:], class_=colour)
    return joined([sign, " ", link, " ", statement, " ", verdict, f": {'; '.join(sentences.facts(claim))}."])


def when_not(found):
    """Every claim that does not hold and could hold: those that fail come first, those that are not testable last."""
    entries = [entry(claim) for kind in failing for claim in found.claims or [] if claim["verdict"] == kind]
    if not entries:
        return element("p", "Every claim that could be tested holds." if found.claims else "Not known without verdicts.")
    return joined([element("p", who, class_="who"), items(entries, "when")])


class Pose:
    """A case of the study work_precision: LBS and PBS as the paper sets it, on the same tets, and the reference."""

    def __init__(self, rows, k_stretch):
        self.name, self.body = case_words.posed(rows[0]), rows[0]["body"]
        self.reference = next((row for row in rows if row["outcome"] == "reference"), None)
        self.lbs = next((row for row in rows if row["deformer"] == "lbs"), None)  # on the case's own mesh, which comes first
        own = [row for row in rows if self.lbs and row["vertices"] == self.lbs["vertices"]]
        self.pbs = next((row for row in own if row["deformer"] == "pbs" and row["iterations"] == "24" and row["order"] == "ordered"
                         and row["precision"] == "f32" and number(row, "k_stretch") == k_stretch and row["substeps"] in ("", "1")), None)

    def is_whole(self):
        return all((self.reference, self.lbs, self.pbs)) and number(self.pbs, "error_joint_pct") is not None


def poses(found):
    """The complete poses, those of the limb first; and the names of the others, including planned ones without a table."""
    all_poses = []
    for file in found.files("work_precision/*/points.csv"):
        name = file.parent.relative_to(found.results).as_posix()
        run = found.run(name, shapes.posed_run) if name in found.runs else {}
        scene = run.get("work", {}).get("settings", {}).get("scene", {})
        rows = found.rows(f"{name}/points.csv")
        if rows:
            all_poses.append(Pose(rows, scene.get("pbs", {}).get("k_stretch", 0.2)))
    whole = [pose for pose in all_poses if pose.is_whole()]
    left_out = [pose.name for pose in all_poses if not pose.is_whole()]
    planned = [run["name"] for run in found.plans.get("work_precision", {"runs": []})["runs"]]
    left_out += [name.replace("_", " ") for name in planned if not found.rows(f"work_precision/{name}/points.csv")]
    return sorted(whole, key=lambda pose: pose.body != "limb"), left_out


def how_far(found):
    """With the names of the poses that lack one of the three, including planned ones."""
    shown, names = poses(found)
    told = f"Left out, since no error of PBS, LBS or the reference is recorded: {'; '.join(names)}."
    left_out = element("p", told, class_="missing") if names else ""
    if not shown:
        told = f"How far PBS is from the finite elements is {not_run(found, 'work_precision')}."
        return left_out or element("p", told, class_="missing")
    pbs, lbs = (span([number(getattr(pose, deformer), "error_joint_pct") for pose in shown]) for deformer in ("pbs", "lbs"))
    told = (f"At the joints, in {counted(len(shown), 'pose')}, PBS with 24 iterations is {pbs} % away from neo-Hookean finite elements, "
            f"LBS {lbs} % (of the mean distance to the bone).")
    return joined([element("p", told, class_="answer"), pose_table(shown), element("p", bar_sentence(shown)), left_out])


def pose_table(shown):
    bounds = [number(pose.pbs, "reference_error_joint_pct") for pose in shown]
    rows = [[pose.name, *(figure(number(row, "error_joint_pct")) for row in (pose.lbs, pose.pbs)),
             "\u2013" if bound is None else f"\u2264 {figure(bound)}", figure(number(pose.reference, "masked_share_pct"))]
            for pose, bound in zip(shown, bounds)]
    header = ["pose", "LBS", "PBS", "reference's own error", "left out [% of the volume]"]
    return table("Distance from the FEM reference at the joints [%]", header, rows)


def bar_sentence(shown):
    """States the error of the reference, which is itself a computation."""
    below = sum(pose.pbs["below_reference_error"] == "1" for pose in shown)
    if not below:
        return "Each of these distances exceeds the bound on the reference's own error."
    return (f"In {below} of {counted(len(shown), 'pose')} PBS lies within the bound on the reference's own error, so that the distance "
            "is not significant.")


def frame_sentence(found):
    rows = [row for row in found.rows("timing/timing.csv") if row["paper_frames_per_s"]]
    quick, plain = ([row for row in rows if (row["variant"], row["precision"]) == kernel]
                    for kernel in (("ordered", "f32"), ("plain", "f64")))
    if not quick or not plain:
        return f"A frame's time at the paper's mesh sizes is {not_run(found, 'timing')}."

    def told(rows, column):
        return span([number(row, column) for row in rows])

    return joined([element("b", f"PBS, 24 iterations, meshes of Table 1's sizes, one core ({quick[0]['cpu_model']}): "
                                f"{told(quick, 'total_wall_ms')} ms per frame"),
                   f" in single precision and ordered ({told(quick, 'frames_per_s')} frames per second); "
                   f"plain loops in double precision take {told(plain, 'total_wall_ms')} ms "
                   f"({told(plain, 'frames_per_s')} frames per second; Table 1 prints "
                   f"{told(plain, 'paper_frames_per_s')})."])


def beside_sentence(found):
    shown = [pose for pose in poses(found)[0] if number(pose.reference, "reach_ms") is not None]
    if not shown:
        return ""
    ms = {name: span([number(getattr(pose, name), "ms_median") for pose in shown]) for name in ("lbs", "pbs")}
    reference_s = span([number(pose.reference, "reach_ms") / 1e3 for pose in shown])
    return f"In the poses of the comparison: LBS {ms['lbs']} ms, PBS {ms['pbs']} ms, the FEM reference {reference_s} s per pose."


def first_screen(found):
    costs = [told for told in (frame_sentence(found), beside_sentence(found), origin.costs_sentence(found)) if told]
    cards = [("Do the paper\u2019s claims hold?", "hold", do_they_hold(found)), ("When not?", "not", when_not(found)),
             ("How far from the finite elements?", "far", how_far(found)), ("At what cost?", "cost", items(costs, "answers"))]
    return joined((element("section", joined([element("h2", title), content]), class_=f"card {name}") for title, name, content in cards),
                  "\n")
