"""The figures of a run's page: its numbers over the frames, and error against run time."""
import pathlib
import statistics
import tempfile

import records
from drawing import style
from report.figures import inline_svg
from report.markup import Markup, element, joined
from report.record_set import number
from report.run_tables import known
from words import looks

measures = (("volume_change_pct", "volume change [%]"), ("error_joint_pct", "error at the joints [%]"), ("inverted_tets", "inverted tets"))


def abscissa(rows):
    """Angles of a sweep, or times."""
    angles = [number(row, "angle_deg") for row in rows]
    if all(angle is not None for angle in angles):
        return angles, "angle [degrees]"
    return [number(row, "time_s") for row in rows], "time [s]"


def values_of(rows, column):
    return [number(row, column) if number(row, column) is not None else float("nan") for row in rows]


def over_frames(found):
    rows = {label: found.rows(label) for label in found.labels()}
    shown = [(column, name) for column, name in measures
             if any(number(row, column) not in (None, 0.0) for of in rows.values() for row in of)] or measures[:1]
    figure, axes = style.panels(len(shown), 1, height_in=1.7, width_in=style.page_in, sharex=True)
    for panel, (column, name) in zip(axes[:, 0], shown):
        for label, of in rows.items():
            x, unit = abscissa(of)
            look = looks.of(label)
            panel.plot(x, values_of(of, column), color=look.color, linestyle=look.line, marker=look.marker, markevery=max(1, len(x) // 9),
                       label=look.name)
        panel.set_ylabel(name)
        panel.margins(x=0)
    axes[-1][0].set_xlabel(unit)
    style.legend_above(figure)
    return figure


def error_against_time(found):
    """One point per deformer; None if the run has no errors."""
    points = {}
    for label in found.labels():
        rows = found.rows(label)
        errors, times_ms = [error for error in known(rows, "error_joint_pct") if error], known(rows, "step_ms")
        if errors and times_ms:
            points[label] = statistics.median(times_ms), statistics.median(errors)
    if not points:
        return None
    figure, axes = style.panels(1, 1, height_in=2.6, width_in=style.page_in * 0.6)
    for label, (ms, error) in points.items():
        look = looks.of(label)
        axes[0][0].plot([ms], [error], color=look.color, marker=look.marker, linestyle="none", label=look.name, markersize=6)
    style.decades(axes[0][0].xaxis)
    axes[0][0].set(xlabel="median time of a step [ms]", ylabel="median error at the joints [%]")
    axes[0][0].set_ylim(bottom=0)
    style.legend_above(figure, 3)
    return figure


def drawn(found, name, figure, caption):
    origin = records.origin_of({found.name: found.record})
    with tempfile.TemporaryDirectory() as folder:
        stem = pathlib.Path(folder) / name
        style.save(figure, stem, origin, [{"figure": name}], formats=("svg",))
        text = stem.with_suffix(".svg").read_text()
    picture = element("div", inline_svg(text, name, caption), class_="scroll drawing")
    return element("figure", joined([picture, element("figcaption", caption)], "\n"), id=f"figure-{name}")


def section(found):
    parts = [drawn(found, "over-frames", over_frames(found), "The numbers of metrics.csv over the frames.")]
    against_time = error_against_time(found)
    if against_time:
        caption = "Error against run time: the median over the frames of the error at the joints and of the time of a step."
        parts.append(drawn(found, "error-against-time", against_time, caption))
    return joined([element("p", Markup("Values are shown next to the pointer or the finger.")), *parts], "\n")
