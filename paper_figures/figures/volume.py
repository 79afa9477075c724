"""The figures of the volume study: the change over the angle of a sweep, over the clip, against the iterations, and by region of the body;
signed (the paper's measure) and absolute (in which gains do not hide losses)."""
import records
from drawing import style
from records import entries
from words import looks
from words.number_words import figure

swept = [("limb_twist", "twist"), ("limb_bend", "bend")]
measures = [("volume_change_pct", "signed volume\nchange [%]"), ("volume_abs_change_pct", "absolute volume\nchange [%]")]


def volume_over_angle(results, figures):
    figure, axes = style.panels(2, 2, height_in=1.9, sharex="col")
    behind = []
    for column, (scene, motion) in enumerate(swept):
        run = records.Run(results / "volume" / scene)
        deformers = {"lbs": None, "dqs": None, "pbs": 24, run.reference(): None}
        for deformer, iterations in deformers.items():
            rows = run.select(deformer, iterations)
            angle_deg = records.numbers(rows, "angle_deg")
            for row, (measure, _) in enumerate(measures):
                style.draw(axes[row][column], deformer, angle_deg, records.numbers(rows, measure))
            behind += style.columns_of(rows, "angle_deg", *(measure for measure, _ in measures))
        axes[0][column].set_title(f"limb, {motion}")
        axes[1][column].set_xlabel(f"{motion} angle [degrees]")
        axes[1][column].xaxis.set_major_locator(style.ticker.MultipleLocator(30))
    for row, (_, label) in enumerate(measures):
        axes[row][0].set_ylabel(label)
        for panel in axes[row]:
            style.paper_band(panel, signed=row == 0)
            style.per_cent_scale(panel, signed=row == 0)
    style.legend_above(figure, columns=3)
    style.save(figure, figures / "volume_over_angle", entries.origin_of(results, "volume_over_angle"), behind)


# The volume change of each deformer over the clip on the human, compared with neo-Hookean finite elements.

def volume_over_clip(results, figures):
    run = records.Run(results / "volume" / "human_01_01")
    figure, axes = style.panels(2, 1, height_in=1.7, width_in=style.page_in, sharex=True)
    behind = []
    for deformer, iterations in {"lbs": None, "dqs": None, "pbs": 24, run.reference(): None}.items():
        rows = run.select(deformer, iterations)
        time_s = records.numbers(rows, "time_s")
        for panel, (measure, _) in zip(axes[:, 0], measures):
            style.draw(panel, deformer, time_s, records.numbers(rows, measure), linewidth=0.8)
        behind += style.columns_of(rows, *(measure for measure, _ in measures))
    for number, (panel, (_, label)) in enumerate(zip(axes[:, 0], measures)):
        style.paper_band(panel, signed=number == 0)
        style.per_cent_scale(panel, signed=number == 0)
        panel.set_ylabel(label)
        panel.margins(x=0)
    axes[1][0].set_xlabel("time in the clip [s]")
    style.legend_above(figure)
    style.save(figure, figures / "volume_over_clip", entries.origin_of(results, "volume_over_clip"), behind)


# Volume change of PBS against the number of iterations: for the human the median over the clip's frames and the band that contains 8
# frames in 10, for the limb single poses.

poses = [("limb_twist", 90, "limb, twist 90\u00b0"), ("limb_twist", 180, "limb, twist 180\u00b0"), ("limb_bend", 90, "limb, bend 90\u00b0"),
         ("limb_bend", 150, "limb, bend 150\u00b0")]


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
        panel.set_ylabel(label.replace("\n", " "))
    style.legend_above(drawing)
    style.save(drawing, figures / "volume_over_iterations", entries.origin_of(results, "volume_over_iterations"), behind)


# The distribution of the human's volume change over the clip: the change of each bone's and each joint's region, in per cent of the whole
# body, mean over frames. LBS loses volume at shoulders, spine and hips; what PBS still loses lies along the spine.

of_regions = ("lbs", "dqs", "pbs", "nh_p1")
region_columns = {"run", "deformer", "kind", "bone", "second_bone", "rest_share_pct", "change_pct", "own_change_pct"}
run_shown = "human_01_01"
most_regions = 10


def largest(rows):
    """The regions that LBS changes most, the largest loss first."""
    of_lbs = [row for row in rows if row["deformer"] == "lbs"]
    of_lbs.sort(key=lambda row: -abs(float(row["change_pct"])))
    return [bones_of(row) for row in of_lbs[:most_regions]]


def bones_of(row):
    """The bone of the region, or the two bones of a joint."""
    return tuple(row[column] for column in ("bone", "second_bone") if row[column])


def in_words(bones):
    """The name of a bone, or of the two bones of a joint with their side only once."""
    first, *second = bones
    return "\u2013".join([style.bone_in_words(first), *(style.bone_in_words(bone, first) for bone in second)])


def draw_kind(axes, rows):
    regions = largest(rows)
    behind = []
    for deformer in of_regions:
        shown = sorted((row for row in rows if row["deformer"] == deformer and bones_of(row) in regions),
                       key=lambda row: regions.index(bones_of(row)))
        look = looks.of(deformer)
        axes.plot(records.numbers(shown, "change_pct"), [regions.index(bones_of(row)) for row in shown], linestyle="none", color=look.color,
                  marker=look.marker, markersize=4, label=look.name)
        behind += [{name: row[name] for name in row if name in region_columns} for row in shown]
    axes.axvline(0, color=style.black, linewidth=0.6)
    axes.set_yticks(range(len(regions)), list(map(in_words, regions)))
    axes.set_ylim(len(regions) - 0.5, -0.5)
    axes.set_xlabel("change [% of the body's volume]")
    return behind


def volume_by_region(results, figures):
    file = results / "volume" / "regions.csv"
    rows = [row for row in records.table(file, region_columns) if row["run"] == run_shown and row["deformer"] in of_regions]
    if not rows:
        raise records.RecordsMissing(f"{file}: no rows of {run_shown}")
    figure, axes = style.panels(1, 2, height_in=2.3)
    behind = []
    for panel, kind, title in zip(axes[0], ("bone", "joint"), ("by nearest bone", "blended between two bones")):
        behind += draw_kind(panel, [row for row in rows if row["kind"] == kind])
        panel.set_title(f"human, {title}")
    style.legend_above(figure)
    style.save(figure, figures / "volume_by_region", entries.origin_of(results, "volume_by_region"), behind)
