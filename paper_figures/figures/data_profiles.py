"""Data profiles (More and Wild 2009): the share of the evaluated poses that a group of deformers solves to 10, 5 and 2 % within a time per
frame, for packed f32 code (above) and plain f64 code (below). The omissions of both are listed below them."""
import records
from drawing import omission_boxes, style
from records import entries
from words import looks

columns = ("comparison", "tolerance_pct", "group", "ms", "solved", "certain", "poses", "share_pct")
comparisons = {"packed_f32": "packed f32 code", "plain_f64": "plain f64 code"}
tolerances_pct = (10.0, 5.0, 2.0)


def draw_profiles(axes, rows, span_ms):
    """A group's share rises at each of its rows; curves that coincide are drawn slightly apart."""
    groups = looks.in_order({row["group"] for row in rows})
    for place, group in enumerate(groups):
        look = looks.of(group)
        steps = [row for row in rows if row["group"] == group]
        ms, share = records.numbers(steps, "ms"), records.numbers(steps, "share_pct")
        apart = 0.5 * (place - (len(groups) - 1) / 2)
        axes.step([ms[0], *ms, span_ms[1]], [apart, *(value + apart for value in share), share[-1] + apart], where="post",
                  color=look.color, marker=look.marker, markersize=2.8, markevery=list(range(1, len(ms) + 1)), label=look.name,
                  linewidth=1.0)


def omitted_in(results, rows, comparison):
    """The omissions of the evaluated poses, and per tolerance the groups without a curve because they solve no pose."""
    lines = omission_boxes.lines(omission_boxes.added_up(results, comparison, omission_boxes.evaluated_cases(results)))
    fronts = records.table(results / "work_precision" / "fronts.csv", {"comparison", "front"})
    known = {looks.group_of(row["front"]) for row in fronts if row["comparison"] == comparison and row["front"] != "all"}
    for tolerance_pct in tolerances_pct:
        drawn = {row["group"] for row in rows if row["comparison"] == comparison and float(row["tolerance_pct"]) == tolerance_pct}
        without = [looks.short(group) for group in looks.in_order(known - drawn)]
        lines += [f"no pose solved to {tolerance_pct:g} %: {', '.join(without)}"] if without else []
    return lines


def data_profiles(results, figures):
    rows = records.table(results / "work_precision" / "data_profiles.csv", set(columns))
    times = records.numbers(rows, "ms")
    span_ms = (min(times) / 1.5, max(times) * 1.5)
    shown = [name for name in comparisons if any(row["comparison"] == name for row in rows)]
    figure, lines_of_axes = style.stacked(*[(len(tolerances_pct), 2.1), (1, 0.9)] * len(shown))
    behind = [{name: row[name] for name in columns} for row in rows]
    for place, comparison in enumerate(shown):
        panels, below = lines_of_axes[2 * place], lines_of_axes[2 * place + 1][0]
        for tolerance_pct, panel in zip(tolerances_pct, panels):
            chosen = [row for row in rows if row["comparison"] == comparison and float(row["tolerance_pct"]) == tolerance_pct]
            draw_profiles(panel, chosen, span_ms)
            style.decades(panel.xaxis)
            panel.set(xlim=span_ms, ylim=(-4, 104), title=f"{comparisons[comparison]}, error at most {tolerance_pct:g} %",
                      xlabel="time per frame [ms]")
        panels[0].set_ylabel(f"solved poses [% of {rows[0]['poses']}]")
        omitted = omitted_in(results, rows, comparison)
        omission_boxes.draw_below(below, omitted, 165)
        behind += [{"comparison": comparison, "omission": line} for line in omitted]
    style.legend_above(figure, columns=4)
    style.save(figure, figures / "data_profiles", entries.origin_of(results, "data_profiles"), style.aligned(behind))
