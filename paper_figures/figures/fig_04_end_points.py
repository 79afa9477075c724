"""The paper's Fig. 4 and the rule of Eq. 2, drawn from the records: the end points s_j and d_j of a bone, the projection of a vertex on it,
and the blended vertices over their parameter on the nearest bone."""
import numpy

from drawing import bodies, style
from records import recorded_frames

low, high = 1 / 6, 5 / 6  # Eq. 2: vertices between these parameters are rigid
kinds = {"0": ("one bone", style.sky, "o"), "1": ("blended between bones", style.vermillion, "^")}


def chosen_vertex(frames, points):
    """A vertex on the forearm's skin, in the plane of drawing and within the rigid zone."""
    rows = [row for row in frames.binding() if row["bone"] == "forearm" and 0.25 < float(row["parameter"]) < 0.45]
    return max(rows, key=lambda row: points[int(row["vertex"])][1] - abs(points[int(row["vertex"])][2]))


def draw_limb(panel, frames):
    """The limb at rest from the side: a slice around the plane of drawing, the bones, and one vertex with its projection."""
    points, binding = bodies.rest_positions_of(frames.tets("lbs", 0)), frames.binding()
    for blended, (label, color, marker) in kinds.items():
        shown = points[[int(row["vertex"]) for row in binding if row["blended"] == blended]]
        shown = shown[abs(shown[:, 2]) < 0.06]
        panel.plot(*shown.T[:2], linestyle="", marker=marker, color=color, markersize=1.6, label=label)
    for bone in frames.bones(0):
        panel.plot(*zip(bone.head[:2], bone.tail[:2]), color=style.black, linewidth=2.5, marker="o", markersize=5)
        for share in (low, high):
            panel.axvline(bone.head[0] + share * (bone.tail[0] - bone.head[0]), color=style.black, linewidth=0.8, linestyle=(0, (4, 2)))
    mark_vertex(panel, frames, points)
    panel.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", ylim=(-0.2, 0.42), title="limb at rest; dashed: 1/6 and 5/6 of each bone")


def mark_vertex(panel, frames, points):
    row, bone = chosen_vertex(frames, points), frames.bones(0)[1]
    vertex = points[int(row["vertex"])]
    foot = bone.head + float(row["parameter"]) * (bone.tail - bone.head)
    panel.plot(*zip(vertex[:2], foot[:2]), color=style.black, linewidth=1, marker="D", markersize=3)
    texts = {r"$s_j$": bone.head, r"$d_j$": bone.tail}
    for text, end in texts.items():
        panel.annotate(text, end[:2], (0, 32), textcoords="offset points", ha="center", arrowprops={"arrowstyle": "-", "linewidth": 0.5})
    panel.annotate(f"$v_i$, at {float(row['parameter']):.2f}\nof the bone", vertex[:2], (14, 8),
                   textcoords="offset points", ha="left", arrowprops={"arrowstyle": "-", "linewidth": 0.5})


def draw_rule(panel, frames):
    """Every vertex of the human at its parameter; the zone of Eq. 2 is grey."""
    binding = frames.binding()
    panel.axvspan(low, high, color="#E8E8E8", linewidth=0, zorder=0)
    for blended, (label, color, marker) in kinds.items():
        rows = [row for row in binding if row["blended"] == blended]
        x, y = ([float(row[name]) for row in rows] for name in ("parameter", "rest_distance_m"))
        named = f"human's vertices {'on ' if blended == '0' else ''}{label}: {len(rows)}"
        panel.plot(x, 1000 * numpy.array(y), linestyle="", marker=marker, color=color, markersize=1.6, label=named)
    panel.set(xlabel="position of its projection from $s_j$ (0) to $d_j$ (1) [1]", ylabel="distance to the bone [mm]", xlim=(-0.25, 1.75))
    panel.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=2)


def fig_04_end_points(results, figures):
    limb, human = (recorded_frames.Frames(results, scene) for scene in ("limb_bend", "human_walk"))
    figure, (first, second) = style.stacked((1, 1.75), (1, 1.9))
    draw_limb(first[0], limb)
    draw_rule(second[0], human)
    behind = [{"scene": frames.run.name, **row} for frames in (limb, human) for row in frames.binding()]
    style.save(figure, figures / "fig_04_end_points", recorded_frames.origin_of(limb, human), behind)
