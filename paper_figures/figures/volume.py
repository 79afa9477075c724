"""The figures of bodies' shape. The volume change over the angle of a sweep, over the clip, against the iterations, and
by region of the body; signed (the paper's measure) and absolute (in which gains do not hide losses). The area of
cross-sections along a limb."""
import records
from drawing import style
from words import looks
from words.number_words import figure

measures = {"volume_change_pct": "signed volume\nchange [%]", "volume_abs_change_pct": "absolute volume\nchange [%]"}


def flesh_of(run):
    """The run's reference, or neo-Hookean finite elements that the run has without one; neither in a run of skinning
    alone."""
    deformers = {row["deformer"] for row in run.rows}
    return [run.reference(needed=False) or "nh_p1"] if run.reference(needed=False) or "nh_p1" in deformers else []


def draw_deformers(panels, run, x, **options):
    """Each deformer, compared with neo-Hookean finite elements, in one panel per measure. Returns the rows."""
    behind = []
    for deformer, iterations in {"lbs": None, "dqs": None, "pbs": 24, **dict.fromkeys(flesh_of(run))}.items():
        rows = run.select(deformer, iterations)
        for panel, measure in zip(panels, measures):
            style.draw(panel, deformer, rows, x, measure, **options)
        behind += rows
    for panel, measure in zip(panels, measures):
        finish_measure(panel, measure)
    return behind


def finish_measure(panel, measure):
    signed = measure == "volume_change_pct"
    panel.axhspan(-0.5 if signed else 0.0, 0.5, color=style.pale, linewidth=0, zorder=0)
    style.per_cent_scale(panel, signed)
    if signed:
        style.name_area(panel, "within 0.5 % (Sec. 4)", (0.01, 0.35))


def volume_over_angle(results):
    drawing, axes = style.panels(2, 2, height_in=1.9, sharex="col")
    behind = []
    for panels, motion in zip(axes.T, ("twist", "bend")):
        behind += draw_deformers(panels, records.Run(results / "volume" / f"limb_{motion}"), "angle_deg")
        panels[1].xaxis.set_major_locator(style.ticker.MultipleLocator(30))
    style.label(axes, ("limb, twist", "limb, bend"), measures.values(),
                ("twist angle [degrees]", "bend angle [degrees]"))
    style.key_below(drawing)
    return drawing, style.columns_of(behind, "angle_deg", *measures)


def volume_over_angle_facts(rows):
    """The largest change of the volume under PBS in each motion [%]."""
    changes = {motion: [abs(float(row["volume_change_pct"])) for row in rows
                        if (row["scene"], row["deformer"]) == (f"limb_{motion}", "pbs")]
               for motion in ("twist", "bend")}
    return {motion: figure(max(of, default=None)) for motion, of in changes.items()}


def volume_over_clip_facts(rows):
    """The frames in which LBS and PBS change the volume by at most 0.5 %."""
    within = {deformer: [abs(float(row["volume_change_pct"])) <= 0.5 for row in rows if row["deformer"] == deformer]
              for deformer in ("lbs", "pbs")}
    return {deformer: sum(found) for deformer, found in within.items()} | {"frames": len(within["pbs"])}


def volume_over_clip(results):
    drawing, axes = style.panels(2, 1, height_in=1.7, sharex=True)
    behind = draw_deformers(axes[:, 0], records.Run(results / "volume" / "human_01_01"), "time_s", linewidth=0.8)
    for panel in axes.flat:
        panel.margins(x=0)
    style.label(axes, (), measures.values(), ["time in the clip [s]"])
    style.key_below(drawing)
    return drawing, style.columns_of(behind, *measures)


# Volume change of PBS against the number of iterations: for the human the median over the clip's frames and the band
# that contains 8 frames in 10, for the limb single poses.

poses = [("limb_twist", 90, "limb, twist 90\u00b0"), ("limb_twist", 180, "limb, twist 180\u00b0"),
         ("limb_bend", 90, "limb, bend 90\u00b0"), ("limb_bend", 150, "limb, bend 150\u00b0")]


def draw_human(axes, run, measure, color):
    """Draws the recorded order statistics over the frames, and returns what was drawn."""
    iterations, quantity = run.pbs_iterations(), measure.removesuffix("_pct")
    rows = [run.statistics("pbs", count) for count in iterations]
    low, median, high = (records.numbers(rows, f"{quantity}_{share}_pct") for share in ("p10", "median", "p90"))
    axes.fill_between(iterations, low, high, color=color, alpha=0.25, linewidth=0)
    axes.plot(iterations, median, color=color, linewidth=1.8, label="human, median;\n10\u201390 % of frames")
    return [{"scene": run.name, "pose": "all frames", "measure": measure, "iterations": of[0], "median": of[1],
             "q10": of[2], "q90": of[3]}
            for of in zip(iterations, median, low, high)]


def volume_over_iterations_facts(rows):
    """The change that remains after 24 and after the most iterations: the human's median, and the limb bent by 90
    degrees [%]."""
    def left(measure, scene, pose):
        found = {int(row["iterations"]): float(row["median"]) for row in rows
                 if (row["measure"], row["scene"], row["pose"]) == (measure, scene, pose)}
        return figure(found[24]), figure(found[max(found)])

    facts = {"most": max(int(row["iterations"]) for row in rows)}
    for name, of in (("human", ("volume_change_pct", "human_01_01", "all frames")),
                     ("bend", ("volume_change_pct", "limb_bend", "90 degrees"))):
        facts[f"{name}_24"], facts[f"{name}_most"] = left(*of)
    return facts


def volume_over_iterations(results):
    human = records.Run(results / "volume" / "human_01_01")
    limbs = {scene: records.Run(results / "volume" / scene) for scene, _, _ in poses}
    drawing, axes = style.panels(1, 2, height_in=2.7)
    behind = []
    for panel, (measure, label) in zip(axes[0], measures.items()):
        behind += draw_human(panel, human, measure, looks.of("pbs").color)
        for (scene, angle_deg, name), place in zip(poses, (0, 4, 2, 6)):
            (color, marker), counts = style.sequence[place], limbs[scene].pbs_iterations()
            values = records.numbers([records.at_angle(limbs[scene].select("pbs", count), angle_deg)
                                      for count in counts], measure)
            panel.plot(counts, values, color=color, marker=marker, linestyle=(0, (4, 1.5)), linewidth=0.9, label=name)
            behind += [{"scene": scene, "pose": f"{angle_deg} degrees", "measure": measure, "iterations": count,
                        "median": value, "q10": "", "q90": ""} for count, value in zip(counts, values)]
        finish_measure(panel, measure)
        panel.set_xscale("log", base=2)
        panel.set_xticks(human.pbs_iterations(), [str(iterations) for iterations in human.pbs_iterations()])
        panel.set(xlabel="iterations per step", ylabel=label.replace("\n", " "))
    style.key_below(drawing)
    return drawing, behind


# The distribution of the human's volume change over the clip: the change of each bone's and each joint's region, in per
# cent of the whole body, mean over frames. LBS loses volume at shoulders, spine and hips; what PBS still loses lies
# along the spine.

of_regions = ("lbs", "dqs", "pbs", "nh_p1")
region_columns = {"run", "deformer", "kind", "bone", "second_bone", "rest_share_pct", "change_pct", "own_change_pct"}
run_shown = "human_01_01"
most_regions = 10


def bones_of(row):
    """The bone of the region, or the two bones of a joint."""
    return tuple(row[column] for column in ("bone", "second_bone") if row[column])


def in_words(bones):
    """The name of a bone, or of the two bones of a joint with their side only once."""
    first, *second = bones
    return "\u2013".join([style.bone_in_words(first), *(style.bone_in_words(bone, first) for bone in second)])


def draw_kind(axes, rows):
    """The regions that LBS changes most, the largest loss first."""
    of_lbs = sorted((row for row in rows if row["deformer"] == "lbs"), key=lambda row: -abs(float(row["change_pct"])))
    regions = [bones_of(row) for row in of_lbs[:most_regions]]
    behind = []
    for deformer in of_regions:
        shown = sorted((row for row in rows if row["deformer"] == deformer and bones_of(row) in regions),
                       key=lambda row: regions.index(bones_of(row)))
        if shown:  # not each run has each deformer
            axes.plot(records.numbers(shown, "change_pct"), [regions.index(bones_of(row)) for row in shown],
                      **style.as_of(deformer, linestyle="none", markersize=4))
        behind += [{name: row[name] for name in row if name in region_columns} for row in shown]
    axes.axvline(0, color=style.ink, linewidth=0.6)
    style.name_rows(axes, list(map(in_words, regions)))
    axes.set_xlabel("change [% of the body's volume]")
    return behind


def volume_by_region(results):
    file = results / "volume" / "regions.csv"
    rows = [row for row in records.table(file, region_columns) if row["run"] == run_shown
            and row["deformer"] in of_regions]
    records.need(rows, f"{file}: no rows of {run_shown}")
    drawing, axes = style.panels(2, 1, height_in=2.3)
    behind = []
    for panel, kind, title in zip(axes[:, 0], ("bone", "joint"), ("by nearest bone", "blended between two bones")):
        behind += draw_kind(panel, [row for row in rows if row["kind"] == kind])
        panel.set_title(f"human, {title}")
    style.key_below(drawing)
    return drawing, behind


# The area of the cross-section relative to rest, along the limb through the joint: LBS collapses at a twisted joint
# (the candy wrapper), and DQS swells at a bent one (the bulge). The curves show where PBS follows the finite elements,
# and where it does not.

cases = [("limb_twist", "twist_90_deg", "limb, twist 90\u00b0"),
         ("limb_twist", "twist_180_deg", "limb, twist 180\u00b0"), ("limb_bend", "bend_60_deg", "limb, bend 60\u00b0"),
         ("limb_bend", "bend_90_deg", "limb, bend 90\u00b0"), ("human_twist_forearm_upper.L", "twist_90_deg",
                                                               "human, elbow twisted 90\u00b0"),
         ("human_bend_shin.L", "bend_90_deg", "human, knee bent 90\u00b0")]
section_columns = {"body", "vertices", "pose", "joint", "deformer", "order", "precision", "offset_m", "area_over_rest"}


def profiles(rows, pose):
    """The sections along the limb for each deformer, on the mesh that all deformers share; of the finite elements,
    those of the best reference."""
    rows = [row for row in rows if row["pose"] == pose
            and (row["order"], row["precision"]) in (("", ""), ("ordered", "f32"))]
    meshes = [row["vertices"] for row in rows if row["deformer"] == "delta_mush"] or [row["vertices"] for row in rows]
    rows = [row for row in rows if row["vertices"] == meshes[0]] if meshes else []
    best = [name for name in ("nh_p2", "nh_p1") if any(row["deformer"] == name for row in rows)][:1]
    found = {name: sorted((row for row in rows if row["deformer"] == name), key=lambda row: float(row["offset_m"]))
             for name in ("lbs", "dqs", "pbs", *best)}
    return {name: of for name, of in found.items() if of}


def section_profiles(results):
    drawing, axes = style.panels(3, 2, height_in=1.65)
    behind = []
    for panel, (case, pose, title) in zip(axes.flat, cases):
        file = results / "artefacts" / case / "profiles.csv"
        found = profiles(records.table(file, section_columns), pose)
        records.need(found, f"{file}: no sections of {pose}")
        for deformer, rows in found.items():
            shown = [{"case": case, "pose": pose, "deformer": deformer, "offset_cm": 100 * offset_m,
                      "area_over_rest_pct": 100 * area}
                     for offset_m, area in zip(records.numbers(rows, "offset_m"),
                                               records.numbers(rows, "area_over_rest"))]
            style.draw(panel, deformer, shown, "offset_cm", "area_over_rest_pct",
                       label="FEM" if deformer.startswith("nh") else looks.short(deformer))
            behind += shown
        panel.axhline(100, color=style.ink, linewidth=0.6)
        panel.set_title(title)
    style.label(axes, (), ["area over rest [%]"] * 3, ["position along the limb, joint at 0 [cm]"] * 2)
    style.key_below(drawing)
    return drawing, behind
