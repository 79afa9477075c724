"""The first screen: the moving character, what PBS is, and the answer in three lines. Every sentence is composed from claims.json,
work_precision/*/points.csv, nearest.csv and fronts.csv of work_precision, and timing/timing.csv."""
import math

from records import shapes
from report import verdicts
from report.markup import Markup, element, joined, table
from report.record_set import not_run, number
from words import case_words, glossary, sentences
from words.number_words import counted, figure, span

what_it_is = ("Position based skinning (PBS) moves a character\u2019s tetrahedral mesh with its bones by linear blend skinning (LBS). "
              "Then it gives the flesh its volume back with a few iterations of stretch, volume and bind constraints.")
where_to_go = Markup("Your own model: <code>pbskin try hero.glb</code>. "
                     "A deformer of your own: <code>experiments/deformers/external/README.md</code> (any program or C library), "
                     "<code>experiments/deformers/README.md</code> (C++).")


def answer(question, sentence, *more):
    """One of the three lines."""
    return element("div", joined([element("h2", question), element("p", sentence), *more]), class_="answer")


def do_they_hold(found):
    question = "Do the paper\u2019s claims hold?"
    if not found.claims:
        sentence = "No verdict is on record: run `pbskin reproduce`, or `pbskin reproduce --judge` on these records."
        return answer(question, element("span", sentence, class_="missing"))
    return answer(question, sentences.counts(found.claims), verdicts.chips(found.claims))


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
        errors = [number(row, "error_joint_pct") for row in (self.lbs, self.pbs)] if self.reference and self.lbs and self.pbs else [None]
        return all(error is not None and math.isfinite(error) for error in errors) and errors[0] > 0

    def removed_pct(self):
        """The share of LBS's error at the joints that PBS removes."""
        return 100 * (1 - number(self.pbs, "error_joint_pct") / number(self.lbs, "error_joint_pct"))


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
    question = "How far is PBS from simulated flesh?"
    shown, _ = poses(found)
    if not shown:
        sentence = f"The distance from finite elements is {not_run(found, 'work_precision')}."
        return answer(question, element("span", sentence, class_="missing"))
    removed_pct = span([round(pose.removed_pct()) for pose in shown])
    sentence = (f"PBS with 24 iterations, ordered and in single precision, removes {removed_pct} % of the error of LBS at the joints "
                f"({counted(len(shown), 'pose')}, against neo-Hookean finite elements).")
    bodies = [pose for pose in shown if pose.body != "limb" and number(pose.pbs, "skin_rms_mm") is not None]
    away = {name: span([number(getattr(pose, name), "skin_rms_mm") for pose in bodies]) for name in ("pbs", "lbs")}
    if away["pbs"] != figure(None):
        sentence += (f" In {counted(len(bodies), 'pose')} of a body of 1.7 m, its skin is {away['pbs']} mm away, that of LBS "
                     f"{away['lbs']} mm.")
    return answer(question, sentence)


def which_method(found):
    question = "Which method for which time?"
    nearest = found.rows("work_precision/nearest.csv")
    rows = [row for row in nearest if (row["among"], row["comparison"]) == ("classes", "packed_f32")]
    if not rows:
        return answer(question, element("span", f"The nearest method is {not_run(found, 'work_precision')}.", class_="missing"))
    means = [row for row in rows if "mean" in row["case"]]
    case = (means or rows)[0]["case"]
    fronts = found.rows("work_precision/fronts.csv")
    lines = [joined([element("b", f"{number(row, 'budget_ms'):g} ms per frame: "), sentences.nearest_class(row, nearest, fronts, True)])
             for row in rows if row["case"] == case]
    lines.append(element("span", f"errors at the joints, {case.replace('_', ' ')}; settings were chosen on other poses", class_="place"))
    return answer(question, joined(lines, Markup("<br>")))


def first_screen(viewer, answers):
    """Beside the moving character: what PBS is, and the answers; the first use of a term links to the glossary."""
    seen = set()
    what, sentence = (glossary.linked(text, seen) for text in (element("p", what_it_is, class_="what"), joined(answers, "\n")))
    return element("div", joined([element("div", viewer, id="viewer", class_="stage"), element("div", joined(
        [what, sentence, element("p", where_to_go, class_="place")], "\n"), class_="answers")], "\n"), class_="first-screen")


# Further down: the distance of each pose, and the cost.

def distances(found):
    """With the names of the poses that lack one of the three, including planned ones."""
    shown, names = poses(found)
    told = f"Left out, since no error of PBS, LBS or the reference is recorded: {'; '.join(names)}."
    left_out = element("p", told, class_="missing") if names else ""
    return joined([pose_table(shown), element("p", bar_sentence(shown)), left_out]) if shown else left_out


def pose_table(shown):
    def ends(pose):
        bound = number(pose.pbs, "reference_error_joint_pct")
        return "\u2013" if bound is None else f"\u2264 {figure(bound)}"

    measures = [("error_joint_pct", "{} [%]"), ("skin_rms_mm", "{}, skin [mm]")]
    rows = [[pose.name, figure(pose.removed_pct()),
             *(figure(number(row, column)) for column, _ in measures for row in (pose.lbs, pose.pbs)),
             ends(pose), figure(number(pose.reference, "masked_share_pct"))] for pose in shown]
    header = ["pose", "share of LBS\u2019s error that PBS removes [%]", *(of.format(name) for _, of in measures for name in ("LBS", "PBS")),
              "reference\u2019s own error [%]", "left out [% of the volume]"]
    return table("Distance from the reference in single poses: at the joints, and over the skin of a body of 1.7 m", header, rows)


def bar_sentence(shown):
    """States the error of the reference, which is itself a computation."""
    bounded = [pose for pose in shown if number(pose.pbs, "reference_error_joint_pct") is not None]
    below = sum(pose.pbs["below_reference_error"] == "1" for pose in bounded)
    without = len(shown) - len(bounded)
    rest = f" {counted(without, 'pose has', 'poses have')} no bound on record." if without else ""
    return (f"In {below} of {counted(len(bounded), 'pose')} with a bound on the reference's own error, PBS lies within the bound, so that "
            f"the distance is not significant.{rest}")


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
