"""The picture of the glossary: a bent limb in section, with the region of the joint, a bone distance, and what the
errors exclude."""
import matplotlib
import numpy

from drawing import style

length, bend = 4.3, numpy.radians(100)  # the limb's radius is 1, and the joint is the origin
upper, lower = numpy.array([-1.0, 0.0]), numpy.array([numpy.cos(bend), numpy.sin(bend)])  # the directions of the bones
inwards = (upper + lower) / numpy.linalg.norm(upper + lower)
tip, mouth = 0.8 * inwards, 1.72 * inwards  # the ends of the crease


def mirrored(points):
    """About the line through the joint and the crease, which exchanges the halves of the limb; in the other order."""
    return (2 * numpy.outer(points @ inwards, inwards) - points)[::-1]


def outlines():
    """Of the limb, and of the region of its joint: Eq. 2 blends the sixth of each bone next to it."""
    t, turn = numpy.linspace(0, 1, 40)[:, None], numpy.linspace(bend, 0, 60) - numpy.pi / 2
    inner = ((1 - t)**3 * [-2.9, 0.96] + 3 * (1 - t)**2 * t * [-2.0, 0.98] + 3 * (1 - t) * t**2
             * (mouth + 0.3 * inwards) + t**3 * mouth)
    half = numpy.vstack([[-length / 6, -1 + 0.14 / 6], [-length, -0.86], [-length, 0.86], inner, tip])
    arc = numpy.column_stack([numpy.cos(turn), numpy.sin(turn)])
    corner = length / 6 * (upper + lower) / (1 + upper @ lower)
    return numpy.vstack([half, mirrored(half), arc, half[:1]]), numpy.vstack([corner, mirrored(half[:1]), arc,
                                                                              half[:1]])


def draw(picture):
    figure, panels = style.panels(1, 1, height_in=3.9, width_in=6.6)
    axes, skin, (limb, region) = panels[0][0], "#B08968", outlines()
    axes.fill(*limb.T, facecolor="#F7E7DB")
    axes.fill(*region.T, facecolor="#BFE0F5")
    axes.plot(*limb.T, color=skin, linewidth=1.8)
    for end, (color, width) in ((end, look) for end in (upper, lower) for look in ((skin, 10), ("white", 7.6))):
        axes.plot(*numpy.outer(end, [0.09 * length, 0.94 * length]), color=color, linewidth=width,
                  solid_capstyle="round")
    axes.plot(0, 0, "o", markersize=10, markerfacecolor="white", markeredgecolor=skin, markeredgewidth=1.4)
    excluded = matplotlib.patches.Circle(tip, 1 / 3, facecolor=style.rose + "44", edgecolor=style.rose, linewidth=1.4)
    axes.add_patch(excluded)
    axes.plot(-2.75, -0.91, "o", color=style.indigo, markersize=5)
    axes.annotate("", (-2.75, -0.91), (-2.75, -0.13), arrowprops={"arrowstyle": "<->", "color": style.indigo,
                                                                  "shrinkA": 0})
    for text, at, to, color in (
            ("vertex", (-2.3, -1.5), (-2.75, -0.91), style.indigo), ("bone distance", (-2.65, -0.5), (-2.75, -0.5),
                                                                     style.indigo),
            ("crease: the skin\ntouches itself", (-2.35, 2.9), mouth, "#333333"),
            ("tip of the crease: excluded within\na third of the limb's radius", (-2.35, 1.75), tip + [-0.3, 0.16],
             style.rose),
            ("region of the joint:\nEq. 2 blends its vertices", (1.55, 0.55), (0.86, 0.1), "#333333"),
            ("joint", (1.55, -0.4), (0.1, -0.03), "#333333"), ("bone", (1.55, 2.6), 2.6 * lower + [0.1, 0], "#333333")):
        axes.annotate(text, to, at, color=color, fontsize=9, ha="right" if "crease" in text else "left", va="center",
                      linespacing=1.35, arrowprops={"arrowstyle": "-", "linewidth": 0.8, "color": color, "shrinkA": 3,
                                                    "shrinkB": 1})
    axes.set(aspect="equal", xlim=(-4.7, 3.7), ylim=(-1.75, 4.4))
    axes.axis("off")
    with matplotlib.rc_context({"svg.fonttype": "path"}):
        figure.savefig(picture, facecolor="white", metadata={"Date": None, "Creator": "pbskin paper_figures"})
