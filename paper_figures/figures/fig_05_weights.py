"""The paper's Fig. 5: the bent limb with rigid weights and with those of Eq. 2, before and after position based dynamics."""
from drawing import bodies, rendering, style
from records import recorded_frames
from words import looks

scenes, angle_deg = ("limb_bend_rigid", "limb_bend"), 90
titles = ("each vertex on one bone", "weights of Eq. 2")
view = rendering.Camera((-0.06, 0.08, 0), 0.29, (-0.25, 0.25, 1.0))


def facts(row):
    return style.signed(f"volume {float(row['volume_change_pct']):+.2f} %, {row['inverted_tets']} inverted tets, "
                        f"smallest section {float(row['min_section_pct']):.0f} %")


def fig_05_weights(results, figures):
    shown = [recorded_frames.Frames(results, scene) for scene in scenes]
    stage = rendering.Stage(1000, 640, background=rendering.paper)
    figure, axes = style.panels(2, 2, height_in=2.35)
    behind = []
    for panels, deformer in zip(axes, ("lbs", "pbs")):
        for panel, frames in zip(panels, shown):
            frame = frames.frame_at_angle(angle_deg)
            behind.append(frames.row(deformer, frame))
            actors = [bodies.skin(frames.tets(deformer, frame))]
            style.show(panel, stage.shot(actors, view), below=facts(behind[-1]))
        panels[0].set_ylabel(looks.of(deformer).name)
    for panel, title in zip(axes[0], titles):
        panel.set_title(title)
    behind = style.columns_of(behind, "angle_deg", "volume_change_pct", "volume_abs_change_pct", "inverted_tets", "min_section_pct")
    style.save(figure, figures / "fig_05_weights", recorded_frames.origin_of(*shown), behind)
