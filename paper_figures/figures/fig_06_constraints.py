"""The paper's Fig. 6, drawn from the records: one tet of the bent limb with its six edge lengths and its volume, at rest, after LBS and
after PBS."""
from itertools import combinations

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

from drawing import bodies, rendering, style
from records import recorded_frames
from words import looks

scene, angle_deg = "limb_bend", 90
edges = list(combinations(range(4), 2))
states = {"rest": style.black, "lbs": looks.of("lbs").color, "pbs": looks.of("pbs").color}
markers = {"rest": "o", "lbs": "v", "pbs": "s"}
titles = {"rest": "at rest", "lbs": "after LBS", "pbs": "after PBS"}


def tets_of(data):
    return vtk_to_numpy(data.GetCells().GetConnectivityArray()).reshape(-1, 4)


def chosen_tet(frames, frame):
    """The tet that LBS has compressed most without inverting it."""
    ratios = vtk_to_numpy(rendering.read(frames.tets("lbs", frame)).GetCellData().GetArray("volume_ratio"))
    return int(numpy.where(ratios > 0.2, ratios, numpy.inf).argmin())


def corners_of(frames, frame, tet):
    """The corners of the tet in each state [m], 4 x 3."""
    corners = tets_of(rendering.read(frames.tets("lbs", frame)))[tet]
    points = {"rest": bodies.rest_positions_of(frames.tets("lbs", frame))}
    points |= {label: bodies.points_of(frames.tets(label, frame)) for label in ("lbs", "pbs")}
    return {state: points[state][corners] for state in states}


def lengths_mm(corners):
    return [1000 * numpy.linalg.norm(corners[one] - corners[other]) for one, other in edges]


def volume_cm3(corners):
    one, two, three = corners[1:] - corners[0]
    return 1e6 * numpy.dot(numpy.cross(one, two), three) / 6


def views(count=200):
    """Directions across and up the page, 2 x 3, from evenly spread viewing directions."""
    for step in range(count):
        height, turn = 1 - 2 * (step + 0.5) / count, numpy.pi * (3 - 5 ** 0.5) * step
        sight = numpy.array([(1 - height ** 2) ** 0.5 * numpy.cos(turn), height, (1 - height ** 2) ** 0.5 * numpy.sin(turn)])
        across = numpy.cross((0, 1, 0), sight) / numpy.linalg.norm(numpy.cross((0, 1, 0), sight))
        yield numpy.array([across, numpy.cross(sight, across)])


def on_page(corners):
    """Projects from the direction in which the corners and the midpoints of the edges are farthest apart."""
    marks = numpy.array([*corners, *(corners[list(edge)].mean(axis=0) for edge in edges)]) - corners.mean(axis=0)

    def nearest(view):
        return min(numpy.linalg.norm(one - other) for one, other in combinations(marks @ view.T, 2))

    return (marks @ max(views(), key=nearest).T)[:4]


def draw_tet(panel, state, corners, rest, title):
    places = on_page(corners)
    for face in combinations(range(4), 3):
        panel.fill(*places[list(face)].T, color=states[state], alpha=0.08, linewidth=0)
    for edge in edges:
        panel.plot(*places[list(edge)].T, color=states[state], linewidth=1.4, marker=markers[state], markersize=4)
    for number, place in enumerate(places, 1):
        panel.annotate(f"$p_{number}$", place, place + 0.014 * place / numpy.linalg.norm(place), ha="center", va="center")
    change_pct = 100 * (volume_cm3(corners) / volume_cm3(rest) - 1)
    text = f"$V$ = {volume_cm3(corners):.1f} cm\u00b3" + (f" ({change_pct:+.0f} %)" if state != "rest" else " = $V_0$")
    panel.set(xticks=[], yticks=[], aspect="equal", title=title, xlabel=style.signed(text))
    panel.spines[:].set_visible(False)
    panel.margins(0.25)


def draw_lengths(panel, corners):
    """|p_i - p_j| of the six stretch constraints."""
    for state, title in titles.items():
        panel.plot([f"{one + 1}{other + 1}" for one, other in edges], lengths_mm(corners[state]), color=states[state], linestyle="",
                   marker=markers[state], markersize=5, label=title, fillstyle="none" if state == "rest" else "full")
    panel.set(xlabel="edge $ij$", ylabel="$|p_i - p_j|$ [mm]", title="six stretch constraints")
    panel.set_ylim(0, 1.35 * max(map(max, map(lengths_mm, corners.values()))))
    panel.legend(loc="upper right", ncol=1, handletextpad=0.2)


def numbers_of(corners):
    lengths = {f"length_{one + 1}{other + 1}_mm": length for (one, other), length in zip(edges, lengths_mm(corners))}
    return {"volume_cm3": volume_cm3(corners), **lengths}


def one_scale(panels):
    """Gives all panels the same scale."""
    half = max(abs(numpy.array([*panel.get_xlim(), *panel.get_ylim()])).max() for panel in panels)
    for panel in panels:
        panel.set(xlim=(-half, half), ylim=(-half, half))


def fig_06_constraints(results, figures):
    frames = recorded_frames.Frames(results, scene)
    frame = frames.frame_at_angle(angle_deg)
    tet = chosen_tet(frames, frame)
    corners = corners_of(frames, frame, tet)
    figure, axes = style.panels(1, 4, height_in=2.1, width_ratios=(1, 1, 1, 1.5))
    for panel, (state, title) in zip(axes[0], titles.items()):
        draw_tet(panel, state, corners[state], corners["rest"], title)
    one_scale(axes[0][:3])
    draw_lengths(axes[0, 3], corners)
    behind = [{"scene": scene, "frame": frame, "tet": tet, "state": state, **numbers_of(corners[state])} for state in states]
    style.save(figure, figures / "fig_06_constraints", recorded_frames.origin_of(frames), behind)
