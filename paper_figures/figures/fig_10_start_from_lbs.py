"""The paper's Fig. 10: poses with and without LBS as the initial guess. No package provides a kicking clip, so the poses are from a
jump."""
import matplotlib

from drawing import bodies, recorded_distances, rendering, style
from records import recorded_frames

scene, shown = "human_jump", (4, 8, 12, 18, 27)
deformers = {"pbs": "from LBS in each frame", "pbs_increment": "moved by LBS's increment"}
scale, colors = matplotlib.colors.Normalize(0, 60), matplotlib.colormaps["YlGnBu"]  # [mm]
direction = (0.8, 0.12, 1.0)


def facts(row):
    return style.signed(f"volume {float(row['volume_change_pct']):+.2f} %\nsmallest section {float(row['min_section_pct']):.0f} %")


def draw_pose(panels, frames, frame, stage):
    low, high = rendering.bounds_of(frames.skin("pbs", frame))
    view = rendering.Camera((low + high) / 2, 0.87, direction)
    rows = [frames.row(label, frame) for label in deformers]
    for panel, label, row in zip(panels, deformers, rows):
        style.show(panel, stage.shot([bodies.skin(frames.skin(label, frame))], view), below=facts(row))
    away_mm = recorded_distances.of_points_mm(frames, frame, *deformers)
    actor = bodies.skin_by(frames.skin("pbs_increment", frame), away_mm, scale, colors)
    apart = recorded_distances.between(frames, frame, *deformers)
    style.show(panels[2], stage.shot([actor], view), below=f"largest {apart['largest_mm']:.0f} mm")
    panels[0].set_title(f"{float(rows[0]['time_s']):.2f} s")
    return rows


def fig_10_start_from_lbs(results, figures):
    frames = recorded_frames.Frames(results, scene)
    stage = rendering.Stage(480, 640, background=rendering.paper)
    figure, axes = style.panels(3, len(shown), height_in=2.2)
    behind = [row for panels, frame in zip(axes.T, shown) for row in draw_pose(panels, frames, frame, stage)]
    for panels, text in zip(axes, (*deformers.values(), "distance between the two")):
        panels[0].set_ylabel(text)
    style.bar(figure, axes, scale, colors, "distance between the two skins [mm]", "max")
    behind = style.columns_of(behind, "volume_change_pct", "volume_abs_change_pct", "inverted_tets", "min_section_pct", "stretch_rms")
    style.save(figure, figures / "fig_10_start_from_lbs", recorded_frames.origin_of(frames), behind)
