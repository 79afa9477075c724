"""Volume change of PBS against the number of iterations: for the human the median over the clip's frames and the band that contains 8
frames in 10, for the limb single poses."""
import records
from drawing import style
from records import entries
from words import looks
from words.number_words import figure

poses = [("limb_twist", 90, "limb, twist 90\u00b0"), ("limb_twist", 180, "limb, twist 180\u00b0"), ("limb_bend", 90, "limb, bend 90\u00b0"),
         ("limb_bend", 150, "limb, bend 150\u00b0")]
measures = [("volume_change_pct", "signed volume change [%]"), ("volume_abs_change_pct", "absolute volume change [%]")]


def draw_human(axes, run, measure, color):
    """Draws the recorded order statistics over the frames, and returns what was drawn."""
    rows = [run.statistics("pbs", iterations) for iterations in run.pbs_iterations()]
    quantity = measure.removesuffix("_pct")
    low, median, high = (records.numbers(rows, f"{quantity}_{share}_pct") for share in ("p10", "median", "p90"))
    iterations = run.pbs_iterations()
    drawn = [{"scene": run.name, "pose": "all frames", "measure": measure, "iterations": of[0], "median": of[1], "q10": of[2], "q90": of[3]}
             for of in zip(iterations, median, low, high)]
    axes.fill_between(iterations, low, high, color=color, alpha=0.25, linewidth=0, label="human, 10\u201390 % of frames")
    axes.plot(iterations, median, color=color, linewidth=1.8, label="human, median")
    return drawn


def draw_pose(axes, run, angle_deg, label, measure, look):
    rows = [records.at_angle(run.select("pbs", iterations), angle_deg) for iterations in run.pbs_iterations()]
    color, marker = look
    values = records.numbers(rows, measure)
    axes.plot(run.pbs_iterations(), values, color=color, marker=marker, linestyle=(0, (4, 1.5)), linewidth=0.9, label=label)
    return [{"scene": run.name, "pose": f"{angle_deg} degrees", "measure": measure, "iterations": iterations, "median": value, "q10": "",
             "q90": ""} for iterations, value in zip(run.pbs_iterations(), values)]


def volume_over_iterations_facts(rows):
    """The change that remains after 24 and after the most iterations: the human's median, and the limb bent by 90 degrees [%]."""
    def left(measure, scene, pose):
        found = {int(row["iterations"]): float(row["median"]) for row in rows
                 if (row["measure"], row["scene"], row["pose"]) == (measure, scene, pose)}
        return figure(found[24]), figure(found[max(found)])

    told = {"most": max(int(row["iterations"]) for row in rows)}
    for name, of in (("human", ("volume_change_pct", "human_01_01", "all frames")),
                     ("bend", ("volume_change_pct", "limb_bend", "90 degrees")),
                     ("absolute", ("volume_abs_change_pct", "human_01_01", "all frames"))):
        told[f"{name}_24"], told[f"{name}_most"] = left(*of)
    return told


def volume_over_iterations(results, figures):
    human = records.Run(results / "volume" / "human_01_01")
    limbs = {scene: records.Run(results / "volume" / scene) for scene, _, _ in poses}
    drawing, axes = style.panels(1, 2, height_in=2.7)
    behind = []
    for panel, (measure, label) in zip(axes[0], measures):
        behind += draw_human(panel, human, measure, looks.of("pbs").color)
        for (scene, angle_deg, name), look in zip(poses, [style.sequence[0], style.sequence[4], style.sequence[2], style.sequence[6]]):
            behind += draw_pose(panel, limbs[scene], angle_deg, name, measure, look)
        style.paper_band(panel, signed=measure == "volume_change_pct")
        style.per_cent_scale(panel, signed=measure == "volume_change_pct")
        panel.set_xscale("log", base=2)
        panel.set_xticks(human.pbs_iterations(), [str(iterations) for iterations in human.pbs_iterations()])
        panel.set_xlabel("iterations per step")
        panel.set_ylabel(label)
    style.legend_above(drawing)
    style.save(drawing, figures / "volume_over_iterations", entries.origin_of(results, "volume_over_iterations"), behind)
