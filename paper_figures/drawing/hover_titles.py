"""The numbers behind a figure's points, in its SVG: an invisible circle over each point has the title "label: x, y",
which browsers show under the pointer. The circles of a panel are in a group of class "values" that names its axes
(data-x, data-y). A drawing of a body, true to scale, has no such circles, since its coordinates are not data."""
from html import escape

import numpy
from matplotlib.collections import PathCollection
from matplotlib.container import BarContainer

points_an_inch = 72  # the unit of matplotlib's SVG
radius = 2.5


def add(figure, file):
    """Also names a replacement for matplotlib's font on machines without it: Verdana has the same width."""
    text = file.read_text().replace(' id="guide"', "").replace("'DejaVu Sans'", "'DejaVu Sans', Verdana, sans-serif")
    page, end = text.rsplit("</svg>", 1)
    height = figure.get_size_inches()[1] * points_an_inch
    groups = [group_of(axes, figure.dpi, height) for axes in figure.axes if axes.get_visible()
              and axes.get_aspect() == "auto"]
    file.write_text(page + "".join(groups) + "</svg>" + end)


def group_of(axes, dpi, height):
    circles = [circle for points in points_of(axes) for circle in circles_of(axes, *points, dpi, height)]
    if not circles:
        return ""
    x, y = (f'"{escape(" ".join(name.split()))}"' for name in (axes.get_xlabel(), axes.get_ylabel()))
    names = f"data-x={x} data-y={y}"
    return f'<g class="values" fill="none" pointer-events="all" {names}>\n' + "\n".join(circles) + "\n</g>\n"


def points_of(axes):
    """(label, x, y of the places, x, y as shown) for each line, cloud of markers and row of bars, except guides and
    lines across the panel."""
    for line in axes.lines:
        if line.get_transform() == axes.transData and line.get_gid() != "guide":
            x, y = line.get_data(orig=False)
            yield line.get_label(), x, y, x, y
    for cloud in axes.collections:
        if isinstance(cloud, PathCollection):
            x, y = numpy.ma.filled(cloud.get_offsets(), numpy.nan).T
            yield cloud.get_label(), x, y, x, y
    for bars in axes.containers:
        if isinstance(bars, BarContainer):
            yield (bars.get_label(), *numpy.array([end_and_length_of(bar, bars.orientation) for bar in bars]).T)


def end_and_length_of(bar, orientation):
    """x and y of the end of a bar, and the value that it shows: in a stack, each bar begins where the previous one
    ends."""
    x, y, width, height = bar.get_x(), bar.get_y(), bar.get_width(), bar.get_height()
    if orientation == "vertical":
        return x + width / 2, y + height, x + width / 2, height
    return x + width, y + height / 2, width, y + height / 2


def circles_of(axes, label, x, y, said_x, said_y, dpi, height):
    """The circles for the points within the panel."""
    places = axes.transData.transform(numpy.column_stack([x, y]).astype(float))
    box = axes.bbox.padded(1.0)
    names = names_of(axes.xaxis), names_of(axes.yaxis)
    prefix = "" if label.startswith("_") else f"{label}: ".replace("\n", " ")
    for place, *values in zip(places, said_x, said_y):
        if numpy.isfinite(place).all() and box.contains(*place):
            across, up = place * points_an_inch / dpi
            text = prefix + ", ".join(name_of(value, known) for known, value in zip(names, values))
            yield (f'<circle cx="{across:.1f}" cy="{height - up:.1f}" '
                   f'r="{radius}"><title>{escape(text)}</title></circle>')


def names_of(axis):
    """The names at the places of an axis whose ticks are not numbers of their own: methods, regions, the settings of a
    map."""
    places = axis.get_majorticklocs()  # panels that share an axis show its names once, but all of them have the names
    texts = dict(zip(places, (text.replace("\n", " ") for text in axis.get_major_formatter().format_ticks(places))))
    return {place: text for place, text in texts.items() if text and "$" not in text and number(text) != place}


def name_of(value, known):
    """The name of this place, or of the nearest one if places have names; otherwise the number to six digits."""
    place = min(known, key=lambda place: abs(place - value), default=None)
    if place is None or abs(place - value) >= 0.5 or (number(known[place]) is not None and place != value):
        return f"{value:.6g}"
    return known[place]


def number(text):
    try:
        return float(text.replace("\N{MINUS SIGN}", "-").replace(",", ""))
    except ValueError:
        return None
