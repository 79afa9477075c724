"""The paper's Fig. 3: the rendered surface at rest, after linear blend skinning and after position based dynamics. The lower row shows the
hips."""
from drawing import bodies, rendering, style
from records import recorded_frames

scene, frame = "human_jump", 8
whole_px, hips_px = (640, 760), (640, 380)


def pictures(frames, stage, centers, half_height_m):
    actors = [bodies.skin(frames.skin_at_rest()), *(bodies.skin(frames.skin(label, frame)) for label in ("lbs", "pbs"))]
    return [stage.shot([actor], rendering.Camera(center, half_height_m)) for actor, center in zip(actors, centers)]


def facts(row):
    return (f"volume {float(row['volume_change_pct']):+.1f} %, {row['inverted_tets']} inverted tet{'s' * (row['inverted_tets'] != '1')}"
            ).replace("-", "\u2212")


def fig_03_two_layers(results, figures):
    frames = recorded_frames.Frames(results, scene)
    rows = [frames.row(label, frame) for label in ("lbs", "pbs")]
    rest, posed = bodies.rest_positions_of(frames.tets("lbs", frame)), bodies.points_of(frames.tets("lbs", frame))
    bodies_at = [(points.min(0) + points.max(0)) / 2 for points in (rest, posed, posed)]
    hips_at = [recorded_frames.middle_of(points, frames.binding(), ("hip.L", "hip.R", "pelvis")) for points in (rest, posed, posed)]
    figure, axes = style.panels(2, 3, height_in=2.4, height_ratios=(2, 1))
    whole = pictures(frames, rendering.Stage(*whole_px, background=rendering.paper), bodies_at, 0.88)
    hips = pictures(frames, rendering.Stage(*hips_px, background=rendering.paper), hips_at, 0.22)
    for panel, picture, title in zip(axes[0], whole, ("rest", "step 1: LBS", "step 2: PBS, 24 iterations")):
        style.show(panel, picture, title)
    for panel, picture, below in zip(axes[1], hips, ("as given", *map(facts, rows))):
        style.show(panel, picture, below=below)
    behind = style.columns_of(rows, "volume_change_pct", "volume_abs_change_pct", "inverted_tets")
    style.save(figure, figures / "fig_03_two_layers", recorded_frames.origin_of(frames), behind)
