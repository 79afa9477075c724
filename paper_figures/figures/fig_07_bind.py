"""The paper's Fig. 7, drawn from the records: a vertex, its projection on the bone, and the distance that the bind constraint keeps, at
rest and in the bent limb after LBS and after PBS."""
import numpy

from drawing import bodies, style
from records import recorded_frames
from words import looks

scene, angle_deg = "limb_bend", 90
labels = ("lbs", "pbs")


def chosen_vertex(frames, posed):
    """The vertex that PBS moved farthest from LBS, among those of the forearm's blended skin in the plane of bending."""
    moved = numpy.linalg.norm((posed["pbs"] - posed["lbs"]) * (1, 1, 0), axis=1)
    rest = bodies.rest_positions_of(frames.tets("lbs", 0))
    rows = [row for row in frames.binding() if row["bone"] == "forearm" and row["blended"] == "1" and row["jiggles"] == "1"]
    near = [int(row["vertex"]) for row in rows if abs(rest[int(row["vertex"])][2]) < 0.02 and rest[int(row["vertex"])][1] < 0]
    return max(near, key=lambda vertex: moved[vertex])


def distance_mm(one, other):
    return 1000 * numpy.linalg.norm(one - other)


def draw_bind(panel, vertex, foot, color, text, marker):
    panel.plot(*zip(foot[:2], vertex[:2]), color=color, linewidth=1.3, marker=marker, markersize=5, zorder=3)
    for name, place, offset in ((text, vertex, (9, -9)), ("$q_i$", foot, (9, 7))):
        panel.annotate(name, place[:2], offset, textcoords="offset points", color=color, ha="left", va="center", fontsize=9)


def draw_state(panel, frames, label, frame):
    """The slice of vertices around the plane of bending, and the bones."""
    file = frames.tets(label, frame)
    points, rest = bodies.points_of(file), bodies.rest_positions_of(file)
    shown = points[abs(rest[:, 2]) < 0.05]
    panel.plot(*shown.T[:2], linestyle="", marker=".", color="#B0B0B0", markersize=2.5)
    for bone in frames.bones(frame):
        panel.plot(*zip(bone.head[:2], bone.tail[:2]), color=style.black, linewidth=2.5, marker="o", markersize=5)
    panel.set(xlabel="x [m]", aspect="equal", xlim=(-0.45, 0.45), ylim=(-0.3, 0.46))


def fig_07_bind(results, figures):
    frames = recorded_frames.Frames(results, scene)
    frame = frames.frame_at_angle(angle_deg)
    rest = bodies.rest_positions_of(frames.tets("lbs", 0))
    posed = {label: bodies.points_of(frames.tets(label, frame)) for label in labels}
    vertex = chosen_vertex(frames, posed)
    feet = {at: frames.projections(frames.bones(at))[vertex] for at in (0, frame)}
    figure, axes = style.panels(1, 3, height_in=2.3)
    shown = ((rest, 0, "$p_i$", style.black, "o", "lbs", "at rest"),
             (posed["lbs"], frame, "$p_{i,LBS}$", looks.of("lbs").color, looks.of("lbs").marker, "lbs", "after LBS"),
             (posed["pbs"], frame, "$p_{i,PBD}$", looks.of("pbs").color, looks.of("pbs").marker, "pbs", "after PBS"))
    for panel, (points, at, text, color, marker, label, title) in zip(axes[0], shown):
        draw_state(panel, frames, label, at)
        draw_bind(panel, points[vertex], feet[at], color, text, marker)
        panel.set_title(f"{title}: $|p_i - q_i|$ = {distance_mm(points[vertex], feet[at]):.0f} mm")
    axes[0, 0].set_ylabel("y [m]")
    behind = [{"scene": scene, "frame": at, "state": title, "vertex": vertex, "distance_mm": distance_mm(points[vertex], feet[at]),
               **dict(zip(("x_m", "y_m", "z_m"), points[vertex]))} for points, at, _, _, _, _, title in shown]
    style.save(figure, figures / "fig_07_bind", recorded_frames.origin_of(frames), behind)
