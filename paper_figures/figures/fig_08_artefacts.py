"""The paper's Fig. 8 with a reference: the limb twisted by 180 degrees and bent by 110 degrees under LBS, DQS, PBS and FEM, with each tet
coloured by its volume ratio. Each row has one camera, and all share one colour bar."""
from drawing import rendering, style
from records import pose_reached, recorded_frames
from words import looks

poses = {"limb_twist": (180, 170), "limb_bend": (110,)}
views = {"limb_twist": rendering.Camera((0, 0, 0), 0.24, (0.0, 0.35, 1.0)),
         "limb_bend": rendering.Camera((0, 0.14, 0), 0.36, (0.0, 0.1, 1.0))}
deformers = ("lbs", "dqs", "pbs", "nh_p1")


def facts(row):
    return style.signed(f"volume {float(row['volume_change_pct']):+.2f} %, {row['inverted_tets']} inverted\n"
                        f"smallest section {float(row['min_section_pct']):.0f} %{pose_reached.mark(row)}")


def draw_row(panels, frames, angle_deg):
    frame, view = frames.frame_at_angle(angle_deg), views[frames.run.name]
    stage = rendering.Stage(900, int(900 * heights[frames.run.name]))
    rows = [frames.row(deformer, frame) for deformer in deformers]
    for panel, deformer, row in zip(panels, deformers, rows):
        style.show(panel, stage.shot([rendering.tets(frames.tets(deformer, frame))], view), below=facts(row))
    panels[0].set_ylabel(f"{frames.run.name.removeprefix('limb_')} {angle_deg}\u00b0")
    return rows


heights = {"limb_twist": 0.62, "limb_bend": 0.9}  # height of a still, relative to its width


def fig_08_artefacts(results, figures):
    scenes = {name: recorded_frames.Frames(results, name) for name in poses}
    shown = [(frames, angle) for name, frames in scenes.items() for angle in poses[name]]
    figure, axes = style.panels(len(shown), len(deformers), height_in=1.75, height_ratios=[heights[frames.run.name] for frames, _ in shown])
    behind = [row for panels, (frames, angle) in zip(axes, shown) for row in draw_row(panels, frames, angle)]
    for panel, deformer in zip(axes[0], deformers):
        panel.set_title(looks.of(deformer).name)
    style.ratio_bar(figure, axes, rendering.ratio_scale, rendering.ratio_colors)
    behind = style.columns_of(behind, "angle_deg", "volume_change_pct", "volume_abs_change_pct", "inverted_tets", "min_section_pct")
    style.save(figure, figures / "fig_08_artefacts", recorded_frames.origin_of(*scenes.values()), behind)
