"""The paper's Fig. 9: the human walking under PBS with its jiggling zone. The skin is coloured by its distance from PBS with the same
stiffness but without a jiggling zone. The camera turns with the hips and shows the front and the back."""
import matplotlib

from drawing import bodies, recorded_distances, rendering, style
from records import recorded_frames
from viewer import data as viewer_data

scene, shown = "human_walk", (0, 12, 24, 36, 48, 60)
compared = ("pbs_jiggle", "pbs_no_zone")
sides = {"front": 1, "back": -1}
scale, colors = matplotlib.colors.Normalize(0, 60), matplotlib.colormaps["YlGnBu"]  # [mm]


def draw_pose(panels, frames, frame, stage):
    away_mm = recorded_distances.of_points_mm(frames, frame, *compared)
    file = frames.skin("pbs_jiggle", frame)
    low, high = rendering.bounds_of(file)
    forward, left = recorded_frames.heading_of(frames.bones(frame))
    for panel, sign in zip(panels, sides.values()):
        actor = bodies.skin_by(file, away_mm, scale, colors)
        style.show(panel, stage.shot([actor], rendering.Camera((low + high) / 2, 0.88, sign * (forward + 0.5 * left) + (0, 0.12, 0))))
    time_s = float(frames.row("pbs_jiggle", frame)["time_s"])
    panels[0].set_title(f"{time_s:.2f} s")
    apart = recorded_distances.between(frames, frame, *compared)
    panels[-1].set_xlabel(f"largest {apart['largest_mm']:.0f} mm")
    bone = recorded_distances.bone_under(frames, int(away_mm.argmax()), frames.tets("pbs_jiggle", frame))
    return {"scene": scene, "frame": frame, "time_s": time_s, **apart, "farthest_bone": bone}


def fig_09_jiggle_facts(rows):
    """The largest distance between the two, frame by frame."""
    def told(row):
        return f"{float(row['largest_mm']):.0f} mm at the {style.bone_in_words(row['farthest_bone'])} ({float(row['time_s']):.2f} s)"

    return {"farthest": ", ".join(map(told, rows)), "first": told(rows[0])}


def fig_09_jiggle(results, figures):
    frames = recorded_frames.Frames(results, scene)
    stage = rendering.Stage(440, 680, background=rendering.paper)
    figure, axes = style.panels(len(sides), len(shown), height_in=2.15)
    behind = [draw_pose(panels, frames, frame, stage) for panels, frame in zip(axes.T, shown)]
    for panels, side in zip(axes, sides):
        panels[0].set_ylabel(side)
    jiggling, still = (viewer_data.title_of(frames, label) for label in compared)
    style.bar(figure, axes, scale, colors, f"distance of the skin under {jiggling}, from that under {still} [mm]", "max")
    style.save(figure, figures / "fig_09_jiggle", recorded_frames.origin_of(frames), behind)
