"""The paper's Figures 2, 4, 6 and 7, drawn from the records: the tets cut open in front of the skeleton, the end points
of a bone and the rule of Eq. 2, one tet with its constraints, and the bind constraint of one vertex."""
from itertools import combinations

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from drawing import bodies, rendering, style
from records.recorded_frames import Frames, heading_of
from words import looks

# Figure 2: human and limb at rest, the human inside the rendered surface.
limb_view = rendering.Camera((0, 0, 0), 0.33, (0.1, 0.3, 1.0))


def opened(frames, skin, towards, view, rod_m):
    """The tets at rest behind their bones, with a transparent skin and the bones in front."""
    file, bones = frames.tets("lbs", 0), frames.bones_at_rest()
    ahead_m = (bodies.rest_positions_of(file) - frames.projections(bones)) @ towards
    front = bodies.skin(skin, ambient=0.6, opacity=0.3), *bodies.bones(bones, rod_m, view.direction)
    return [bodies.cut_open(bodies.at_rest(file), ahead_m), *front]


def fig_02_tets_and_bones(results):
    human, limb = (Frames(results, scene) for scene in ("human_walk", "limb_bend"))
    low, high = rendering.bounds_of(human.skin_at_rest())
    forward, left = heading_of(human.bones_at_rest())
    view = rendering.Camera((low + high) / 2, 0.54 * (high - low)[1], forward + 0.35 * left + (0, 0.1, 0))
    shown = ((human, rendering.read(human.skin_at_rest()), forward, view, 0.009, (1100, 1200), "human, at rest"),
             (limb, bodies.at_rest(limb.tets("lbs", 0)), (0.0, 0.0, 1.0), limb_view, 0.012, (1500, 420),
              "limb, at rest"))
    figure, axes = style.panels(1, 2, height_in=2.8, width_ratios=(1, 1.2))
    behind = []
    for panel, (frames, skin, towards, view, rod_m, pixels, title) in zip(axes[0], shown):
        counts = {name: frames.run.record["character"][name] for name in ("vertices", "tets", "bones")}
        behind.append({"scene": frames.run.name} | counts)
        picture = rendering.Stage(*pixels).shot(opened(frames, skin, towards, view, rod_m), view)
        style.show(panel, picture, title, ", ".join(f"{count} {name}" for name, count in counts.items()))
    return figure, behind


# Figure 4: the end points s_j and d_j of a bone, the projection of a vertex on it, and the blended vertices over their
# parameter on the nearest bone.
low, high = 1 / 6, 5 / 6  # Eq. 2: vertices between these parameters are rigid
kinds = {"0": ("one bone", style.cyan, "o"), "1": ("blended between bones", style.rose, "^")}


def draw_bones(panel, bones):
    for bone in bones:
        panel.plot(*zip(bone.head[:2], bone.tail[:2]), color=style.ink, linewidth=2.5, marker="o", markersize=5)


# Thousands of points, without values under the pointer.
dense = {"linestyle": "", "markersize": 1.6, "rasterized": True, "gid": "guide"}


def draw_limb(panel, frames):
    """The limb at rest from the side: a slice around the plane of drawing, the bones, and one vertex with its
    projection."""
    points, binding = bodies.rest_positions_of(frames.tets("lbs", 0)), frames.binding()
    for blended, (label, color, marker) in kinds.items():
        shown = points[[int(row["vertex"]) for row in binding if row["blended"] == blended]]
        panel.plot(*shown[abs(shown[:, 2]) < 0.06].T[:2], marker=marker, color=color, label=label, **dense)
    for bone in frames.bones(0):
        draw_bones(panel, [bone])
        for share in (low, high):
            panel.axvline(bone.head[0] + share * (bone.tail[0] - bone.head[0]), color=style.ink, linewidth=0.8,
                          linestyle=(0, (4, 2)))
    mark_vertex(panel, frames, points)
    panel.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", ylim=(-0.2, 0.42),
              title="limb at rest; dashed: 1/6 and 5/6 of each bone")


def mark_vertex(panel, frames, points):
    """A vertex on the forearm's skin, in the plane of drawing and within the rigid zone."""
    rows = [row for row in frames.binding() if row["bone"] == "forearm" and 0.25 < float(row["parameter"]) < 0.45]
    row = max(rows, key=lambda row: points[int(row["vertex"])][1] - abs(points[int(row["vertex"])][2]))
    vertex, bone, parameter = points[int(row["vertex"])], frames.bones(0)[1], float(row["parameter"])
    foot = bone.head + parameter * (bone.tail - bone.head)
    panel.plot(*zip(vertex[:2], foot[:2]), color=style.ink, linewidth=1, marker="D", markersize=3)
    for text, end, offset, side in ((r"$s_j$", bone.head, (0, 32), "center"), (r"$d_j$", bone.tail, (0, 32), "center"),
                                    (f"$v_i$, at {parameter:.2f}\nof the bone", vertex, (14, 8), "left")):
        panel.annotate(text, end[:2], offset, textcoords="offset points", ha=side,
                       arrowprops={"arrowstyle": "-", "linewidth": 0.5})


def draw_rule(panel, frames):
    """Every vertex of the human at its parameter; the zone of Eq. 2 is grey."""
    panel.axvspan(low, high, color=style.pale, linewidth=0, zorder=0)
    for blended, (label, color, marker) in kinds.items():
        rows = [row for row in frames.binding() if row["blended"] == blended]
        x, y = ([float(row[name]) for row in rows] for name in ("parameter", "rest_distance_m"))
        named = f"human's vertices {'on ' if blended == '0' else ''}{label}: {len(rows)}"
        panel.plot(x, 1000 * numpy.array(y), marker=marker, color=color, label=named, **dense)
    panel.set(xlabel="position of its projection from $s_j$ (0) to $d_j$ (1) [1]", ylabel="distance to the bone [mm]",
              xlim=(-0.25, 1.75))
    panel.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))


def fig_04_end_points(results):
    limb, human = (Frames(results, scene) for scene in ("limb_bend", "human_walk"))
    figure, (first, second) = style.stacked((1, 1.7), (1, 2.6))
    draw_limb(first[0], limb)
    draw_rule(second[0], human)
    return figure, [{"scene": frames.run.name, **row} for frames in (limb, human) for row in frames.binding()]


def fig_04_end_points_facts(rows):
    """How many of the human's vertices are blended."""
    human = [row for row in rows if row["scene"] == "human_walk"]
    return {"blended": f"{sum(row['blended'] == '1' for row in human):,}", "vertices": f"{len(human):,}"}


# Figure 6: one tet of the bent limb with its six edge lengths and its volume, at rest, after LBS and after PBS.
edges = list(combinations(range(4), 2))
states = {"rest": (style.ink, "o", "at rest"), "lbs": (looks.of("lbs").color, "v", "after LBS"),
          "pbs": (looks.of("pbs").color, "s", "after PBS")}


def lengths_mm(corners):
    return [1000 * numpy.linalg.norm(corners[one] - corners[other]) for one, other in edges]


def volume_cm3(corners):
    one, two, three = corners[1:] - corners[0]
    return 1e6 * numpy.dot(numpy.cross(one, two), three) / 6


def views(count=200):
    """Directions across and up the page, 2 x 3, from evenly spread viewing directions."""
    for step in range(count):
        height, turn = 1 - 2 * (step + 0.5) / count, numpy.pi * (3 - 5 ** 0.5) * step
        sight = numpy.array([(1 - height ** 2) ** 0.5 * numpy.cos(turn), height,
                             (1 - height ** 2) ** 0.5 * numpy.sin(turn)])
        across = numpy.cross((0, 1, 0), sight) / numpy.linalg.norm(numpy.cross((0, 1, 0), sight))
        yield numpy.array([across, numpy.cross(sight, across)])


def on_page(corners):
    """Projects from the direction in which the corners and the midpoints of the edges are farthest apart."""
    marks = numpy.array([*corners, *(corners[list(edge)].mean(axis=0) for edge in edges)]) - corners.mean(axis=0)

    def nearest(view):
        return min(numpy.linalg.norm(one - other) for one, other in combinations(marks @ view.T, 2))

    return (marks @ max(views(), key=nearest).T)[:4]


def draw_tet(panel, state, corners, rest):
    places, (color, marker, title) = on_page(corners), states[state]
    for face in combinations(range(4), 3):
        panel.fill(*places[list(face)].T, color=color, alpha=0.08, linewidth=0)
    for edge in edges:
        panel.plot(*places[list(edge)].T, color=color, linewidth=1.4, marker=marker, markersize=4)
    for number, place in enumerate(places, 1):
        panel.annotate(f"$p_{number}$", place, place + 0.014 * place / numpy.linalg.norm(place), ha="center",
                       va="center")
    change_pct = 100 * (volume_cm3(corners) / volume_cm3(rest) - 1)
    text = f"$V$ = {volume_cm3(corners):.1f} cm\u00b3" + (f" ({change_pct:+.0f} %)" if state != "rest" else " = $V_0$")
    panel.set(xticks=[], yticks=[], aspect="equal", title=title, xlabel=style.signed(text))
    panel.spines[:].set_visible(False)
    panel.margins(0.25)


def draw_lengths(panel, corners):
    """|p_i - p_j| of the six stretch constraints."""
    for state, (color, marker, title) in states.items():
        panel.plot([f"{one + 1}{other + 1}" for one, other in edges], lengths_mm(corners[state]), color=color,
                   linestyle="", marker=marker, markersize=5, label=title,
                   fillstyle="none" if state == "rest" else "full")
    panel.set(xlabel="edge $ij$", ylabel="length of the edge [mm]", title="six stretch constraints",
              ylim=(0, 1.35 * max(map(max, map(lengths_mm, corners.values())))))
    panel.legend(loc="upper right", ncol=1, handletextpad=0.2)


def fig_06_constraints(results):
    frames = Frames(results, "limb_bend")
    frame = frames.frame_at_angle(90)
    lbs = frames.tets("lbs", frame)
    ratios = vtk_to_numpy(rendering.read(lbs).GetCellData().GetArray("volume_ratio"))
    # The one that LBS has compressed most without inverting it.
    tet = int(numpy.where(ratios > 0.2, ratios, numpy.inf).argmin())
    points = {"rest": bodies.rest_positions_of(lbs), "lbs": bodies.points_of(lbs),
              "pbs": bodies.points_of(frames.tets("pbs", frame))}
    corners = {state: points[state][rendering.corners_of(rendering.read(lbs))[tet]] for state in states}  # [m], 4 x 3
    figure, (tets, (lengths,)) = style.stacked((3, 1.7), (1, 1.9))
    for panel, state in zip(tets, states):
        draw_tet(panel, state, corners[state], corners["rest"])
    half = max(abs(numpy.array([*panel.get_xlim(), *panel.get_ylim()])).max() for panel in tets)
    for panel in tets:  # one scale
        panel.set(xlim=(-half, half), ylim=(-half, half))
    draw_lengths(lengths, corners)
    return figure, [{"scene": "limb_bend", "frame": frame, "tet": tet, "state": state, "volume_cm3": volume_cm3(of)}
                    | {f"length_{one + 1}{other + 1}_mm": length for (one, other), length in zip(edges, lengths_mm(of))}
                    for state, of in corners.items()]


def fig_06_constraints_facts(rows):
    """The volume after each step [% of that at rest]."""
    volumes = {row["state"]: float(row["volume_cm3"]) for row in rows}
    return {state: f"{100 * volumes[state] / volumes['rest']:.0f}" for state in ("lbs", "pbs")}


# Figure 7: a vertex, its projection on the bone, and the distance that the bind constraint keeps, at rest and in the
# bent limb after LBS and after PBS.

def chosen_vertex(frames, rest, lbs, pbs):
    """The vertex that PBS moved farthest from LBS, among those of the forearm's blended skin in the plane of
    bending."""
    moved = numpy.linalg.norm((pbs - lbs) * (1, 1, 0), axis=1)
    rows = [row for row in frames.binding() if row["bone"] == "forearm" and row["blended"] == "1"
            and row["jiggles"] == "1"]
    near = [int(row["vertex"]) for row in rows if abs(rest[int(row["vertex"])][2]) < 0.02
            and rest[int(row["vertex"])][1] < 0]
    return max(near, key=lambda vertex: moved[vertex])


def fig_07_bind(results):
    """With the slice of vertices around the plane of bending, and the bones."""
    frames = Frames(results, "limb_bend")
    frame = frames.frame_at_angle(90)
    rest = bodies.rest_positions_of(frames.tets("lbs", 0))
    lbs, pbs = (bodies.points_of(frames.tets(label, frame)) for label in ("lbs", "pbs"))
    vertex = chosen_vertex(frames, rest, lbs, pbs)
    figure, axes = style.panels(1, 3, height_in=2.0, sharey=True)
    behind = []
    for panel, points, at, text, (color, _, title), marker in zip(
            axes[0], (rest, lbs, pbs), (0, frame, frame), ("$p_i$", "$p_{i,LBS}$", "$p_{i,PBD}$"), states.values(),
            ("o", looks.of("lbs").marker, looks.of("pbs").marker)):
        place, foot = points[vertex], frames.projections(frames.bones(at))[vertex]
        distance_mm = 1000 * numpy.linalg.norm(place - foot)
        panel.plot(*points[abs(rest[:, 2]) < 0.05].T[:2], linestyle="", marker=".", color=style.light, markersize=2.5)
        draw_bones(panel, frames.bones(at))
        panel.plot(*zip(foot[:2], place[:2]), color=color, linewidth=1.3, marker=marker, markersize=5, zorder=3)
        for name, end, offset in ((text, place, (9, -9)), ("$q_i$", foot, (9, 7))):
            panel.annotate(name, end[:2], offset, textcoords="offset points", color=color, ha="left", va="center")
        panel.set(xlabel="x [m]", aspect="equal", xlim=(-0.45, 0.45), ylim=(-0.3, 0.46),
                  title=f"{title}:\n$|p_i - q_i|$ =\n{distance_mm:.0f} mm")
        behind.append({"scene": "limb_bend", "frame": at, "state": title, "vertex": vertex, "distance_mm": distance_mm,
                       **dict(zip(("x_m", "y_m", "z_m"), place))})
    axes[0, 0].set_ylabel("y [m]")
    return figure, behind


def fig_07_bind_facts(rows):
    """The distances from the bone [mm]."""
    return dict(zip(states, (f"{float(row['distance_mm']):.0f}" for row in rows)))
