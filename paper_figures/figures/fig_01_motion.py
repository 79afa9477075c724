"""The paper's Fig. 1, a character in motion: the human jumping under LBS, PBS, and PBS with its jiggling zone. One camera follows the body
along the floor but not upwards, so that the jump is visible."""
from drawing import bodies, rendering, style
from records import recorded_frames
from words import looks

scene, deformers, shown = "human_jump", ("lbs", "pbs", "pbs_jiggle"), (0, 8, 12, 18, 27, 40)
direction, half_height_m, floor_to_middle_m = (1.0, 0.15, 0.75), 0.98, 0.95


def camera(frames, frame):
    low, high = rendering.bounds_of(frames.skin("lbs", frame))
    middle = (low + high) / 2
    return rendering.Camera((middle[0], floor_to_middle_m, middle[2]), half_height_m, direction)


def facts(row):
    return style.signed(f"volume {float(row['volume_change_pct']):+.1f} %")


def fig_01_motion(results, figures):
    frames = recorded_frames.Frames(results, scene)
    stage = rendering.Stage(440, 720, background=rendering.paper)
    figure, axes = style.panels(len(deformers), len(shown), height_in=2.1)
    behind = []
    for panels, deformer in zip(axes, deformers):
        for panel, frame in zip(panels, shown):
            row = frames.row(deformer, frame)
            behind.append(row)
            style.show(panel, stage.shot([bodies.skin(frames.skin(deformer, frame))], camera(frames, frame)), below=facts(row))
        panels[0].set_ylabel(looks.of(deformer).name)
    for panel, frame in zip(axes[0], shown):
        panel.set_title(f"{float(frames.row('lbs', frame)['time_s']):.2f} s")
    behind = style.columns_of(behind, "volume_change_pct", "volume_abs_change_pct", "inverted_tets")
    style.save(figure, figures / "fig_01_motion", recorded_frames.origin_of(frames), behind)
