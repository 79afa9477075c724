"""Data profiles (More and Wild 2009): the share of the evaluated poses that a group of deformers solves to 10, 5 and 2 % within a time per
frame, for packed f32 code (above) and plain f64 code (below)."""
import compared_looks
import entries
import records
import style

columns = ("comparison", "tolerance_pct", "group", "ms", "solved", "poses", "share_pct")
comparisons = {"packed_f32": "packed f32 code", "plain_f64": "plain f64 code"}
tolerances_pct = (10.0, 5.0, 2.0)


def draw_profiles(axes, rows, span_ms):
    """A group's share rises at each of its rows; curves that coincide are drawn slightly apart."""
    groups = compared_looks.in_order({row["group"] for row in rows})
    for place, group in enumerate(groups):
        name, color, marker = compared_looks.of(group)
        steps = [row for row in rows if row["group"] == group]
        ms, share = records.numbers(steps, "ms"), records.numbers(steps, "share_pct")
        apart = 0.5 * (place - (len(groups) - 1) / 2)
        axes.step([ms[0], *ms, span_ms[1]], [apart, *(value + apart for value in share), share[-1] + apart], where="post", color=color,
                  marker=marker, markersize=2.8, markevery=list(range(1, len(ms) + 1)), label=name, linewidth=1.0)


def draw(results, figures):
    file = results / "work_precision" / "data_profiles.csv"
    rows = records.table(file, set(columns))
    times = records.numbers(rows, "ms")
    span_ms = (min(times) / 1.5, max(times) * 1.5)
    shown = [name for name in comparisons if any(row["comparison"] == name for row in rows)]
    figure, axes = style.panels(len(shown), len(tolerances_pct), height_in=2.1, sharex=True, sharey=True)
    for comparison, line in zip(shown, axes):
        for tolerance_pct, panel in zip(tolerances_pct, line):
            chosen = [row for row in rows if row["comparison"] == comparison and float(row["tolerance_pct"]) == tolerance_pct]
            draw_profiles(panel, chosen, span_ms)
            style.decades(panel.xaxis)
            panel.set(xlim=span_ms, ylim=(-4, 104), title=f"{comparisons[comparison]}, error at most {tolerance_pct:g} %")
            if comparison == shown[-1]:
                panel.set_xlabel("time per frame [ms]")
        line[0].set_ylabel(f"solved poses [% of {rows[0]['poses']}]")
    style.legend_above(figure, columns=4)
    style.save(figure, figures / "data_profiles", entries.origin_of(results, "data_profiles"),
               [{name: row[name] for name in columns} for row in rows])
