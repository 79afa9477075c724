"""The area of the cross-section relative to rest, along the limb through the joint: LBS collapses at a twisted joint (the candy wrapper),
and DQS swells at a bent one (the bulge). The curves show where PBS follows the finite elements, and where it does not."""
import records
from drawing import style
from records import entries

cases = [("limb_twist", "twist_90_deg", "limb, twist 90\u00b0"), ("limb_twist", "twist_180_deg", "limb, twist 180\u00b0"),
         ("limb_bend", "bend_60_deg", "limb, bend 60\u00b0"), ("limb_bend", "bend_90_deg", "limb, bend 90\u00b0"),
         ("human_twist_forearm_upper.L", "twist_90_deg", "human, elbow twisted 90\u00b0"),
         ("human_bend_shin.L", "bend_90_deg", "human, knee bent 90\u00b0")]
columns = {"body", "vertices", "pose", "joint", "deformer", "order", "precision", "offset_m", "area_over_rest"}


def profiles(rows, pose):
    """The sections along the limb for each deformer, on the mesh that all deformers share; of the finite elements, those of the best
    reference."""
    rows = [row for row in rows if row["pose"] == pose and (row["order"], row["precision"]) in (("", ""), ("ordered", "f32"))]
    meshes = [row["vertices"] for row in rows if row["deformer"] == "delta_mush"] or [row["vertices"] for row in rows]
    rows = [row for row in rows if row["vertices"] == meshes[0]] if meshes else []
    best = next((name for name in ("nh_p2", "nh_p1") if any(row["deformer"] == name for row in rows)), None)
    shown = ["lbs", "dqs", "pbs", *([best] if best else [])]
    return {name: sorted((row for row in rows if row["deformer"] == name), key=lambda row: float(row["offset_m"])) for name in shown}


def draw_case(axes, file, pose, title):
    found = {name: rows for name, rows in profiles(records.table(file, columns), pose).items() if rows}
    if not found:
        raise records.RecordsMissing(f"{file}: no sections of {pose}")
    behind = []
    for deformer, rows in found.items():
        offset_cm = [100 * offset_m for offset_m in records.numbers(rows, "offset_m")]
        area_pct = [100 * area for area in records.numbers(rows, "area_over_rest")]
        style.draw(axes, deformer, offset_cm, area_pct)
        behind += [{"case": file.parent.name, "pose": pose, "deformer": deformer, "offset_cm": x, "area_over_rest_pct": y}
                   for x, y in zip(offset_cm, area_pct)]
    axes.axhline(100, color=style.black, linewidth=0.6)
    axes.set_title(title)
    return behind


def section_profiles(results, figures):
    folder = results / "artefacts"
    figure, axes = style.panels(3, 2, height_in=1.65)
    behind = []
    for panel, (case, pose, title) in zip(axes.flat, cases):
        behind += draw_case(panel, folder / case / "profiles.csv", pose, title)
    for panels in axes:
        panels[0].set_ylabel("area over rest [%]")
    for panel in axes[-1]:
        panel.set_xlabel("position along the limb, joint at 0 [cm]")
    style.legend_above(figure)
    style.save(figure, figures / "section_profiles", entries.origin_of(results, "section_profiles"), behind)
