"""Error against run time, for packed f32 code and for plain f64 code: the points and fronts of each evaluated pose, and the share of the
poses that are solved within a time."""
import records
from drawing import omission_boxes, style
from words import case_words, looks

comparisons = {"packed_f32": "packed f32 code", "plain_f64": "plain f64 code"}

# One panel per evaluated pose, and one of their mean: every setting of every deformer, the front of each group of deformers with the
# settings that were chosen on other poses, the deformer that is nearest within 0.1, 1 and 10 ms, the bound on the reference's own error,
# below which differences have no meaning, and what is omitted.

point_numbers = ("deformer", "iterations", "k_stretch", "order", "precision", "substeps", "element_order", "wanted_vertices", "refined",
                 "tuned", "packed", "ms_median", "error_joint_pct")
tables = {"fronts": {"comparison", "case", "measure", "front", "reference_error_joint_pct", *point_numbers},
          "nearest": {"comparison", "case", "budget_ms", "among", "nearest", "deformer", "knows", "either_of", "error_joint_pct",
                      "ms_median"}}
point_columns = {"body", "motion", "pose", "angle_deg", *point_numbers, "outcome", "half", "reach_ms", "reference_error_joint_pct"}
most_panels = 6
name_row_height = 0.048  # of the height of a panel


class Panel:
    """One pose or mean in one comparison, with the rows behind it."""

    def __init__(self, comparison, case, title, points, found):
        def of_case(table, **wanted):
            wanted = {"comparison": comparison, "case": case, **wanted}
            return [row for row in found[table] if all(row[column] == value for column, value in wanted.items())]

        measured = [row for row in points if row["ms_median"] and row["error_joint_pct"]]
        self.is_mean = not points
        self.title, self.points = title, omission_boxes.taking_part(measured, comparison)
        self.fronts = of_case("fronts", measure="error_joint_pct")
        self.best = of_case("nearest", among="classes")
        self.omitted = of_case("omissions")
        bound = next((row["reference_error_joint_pct"] for row in self.fronts), "")
        self.bound_pct = float(bound) if bound else None
        self.reference_s = next((float(row["reach_ms"]) / 1e3 for row in points if row["outcome"] == "reference"), None)

    def heading(self):
        """The pose, and below it the time of the reference and the bound on its error."""
        of_reference = [f"reference {case_words.number(float(f'{self.reference_s:.2g}'))} s"] if self.reference_s else []
        of_reference += [f"bound {self.bound_pct:.2g} %"] if self.bound_pct else []
        return self.title + ("\n" if of_reference else "") + ", ".join(of_reference)


def draw_points(axes, panel):
    at = "ms_median", "error_joint_pct"
    for group in looks.in_order({looks.group_of(row["deformer"]) for row in panel.points + panel.fronts if row.get("front") != "all"}):
        tried = [row for row in panel.points if looks.group_of(row["deformer"]) == group]
        if tried:
            small = {"linestyle": "none", "label": None, "markersize": 2.2, "alpha": 0.25, "markeredgewidth": 0.5}
            style.plot(axes, tried, *at, **style.as_of(group, **small))
        front = group_front([row for row in panel.fronts if row["front"] != "all" and looks.group_of(row["front"]) == group])
        if front:
            style.plot(axes, front, *at, **style.as_of(group, linestyle="-", linewidth=1.0))
    front = [row for row in panel.fronts if row["front"] == "all"]
    if front:
        axes.step(*(records.numbers(front, column) for column in at), where="post", color=style.yellow, linewidth=4.0, alpha=0.6, zorder=0,
                  label="front of all")
    axes.set(xscale="log", yscale="log")


def group_front(rows):
    """The front of a group from those of its deformers."""
    front, least = [], float("inf")
    for row in sorted(rows, key=lambda row: (float(row["ms_median"]), float(row["error_joint_pct"]))):
        if float(row["error_joint_pct"]) < least:
            least = float(row["error_joint_pct"])
            front.append(row)
    return front


def draw_budgets(axes, panel):
    """A line at each budget, and above it the nearest class and its deformer with its error. Each name has a row of its own: the lines are
    too close together for several in one row."""
    for place, row in enumerate(panel.best):
        budget_ms = float(row["budget_ms"])
        mark = f" or {len(row['either_of'].split())} more" if row["either_of"] else ""
        group = looks.group_of(row["deformer"])
        axes.axvline(budget_ms, color="#777777", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
        axes.text(budget_ms, 1.01 + name_row_height * place,
                  f"{budget_ms:g} ms: {words_of_class(row['nearest'])}{mark}: {looks.short(row['deformer'])}, "
                  f"{float(row['error_joint_pct']):.3g} %",
                  transform=axes.get_xaxis_transform(), ha="center", va="bottom", fontsize=5.2, color=looks.of(group).color)


def words_of_class(name):
    """The class; a deformer of the user's own is a class by itself."""
    return name.replace("_", " ")


def undecided_lines(panel):
    """within 10 ms also: mush, blend"""
    return [f"within {float(row['budget_ms']):g} ms also: {', '.join(map(words_of_class, row['either_of'].split()))}" for row in panel.best
            if row["either_of"]]


def draw_panel(axes, panel):
    draw_points(axes, panel)
    low, high = axes.get_ylim()
    low /= (high / low) ** 0.28  # room for the omissions
    if panel.bound_pct and panel.bound_pct > low:
        axes.axhspan(low, min(panel.bound_pct, high), color="#EFEFEF", linewidth=0, zorder=-1,
                     label="below the reference\u2019s own error (bound)")
    axes.set_ylim(low, high)
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis)
    axes.set_title(panel.heading(), pad=30)
    axes.set(xlabel="processor time per frame [ms]", ylabel="error at the joints [%]")
    draw_budgets(axes, panel)
    rule = ["settings without an error in one of the poses"] if panel.is_mean else []
    omission_boxes.draw(axes, rule + omission_boxes.lines(panel.omitted), 46, undecided_lines(panel))


def rows_behind(panel):
    """Points, fronts, the nearest within each budget, omissions and the bound, as rows of one table."""
    of_best = ("budget_ms", "nearest", "deformer", "knows", "either_of", "ms_median", "error_joint_pct")
    rows = style.taken(panel.points, point_numbers, shown="point")
    rows += [row for front in panel.fronts for row in style.taken([front], point_numbers, shown=f"front of {front['front']}")]
    rows += style.taken(panel.best, of_best, shown="nearest")
    rows += style.taken(panel.omitted, ("deformer", "why", "missing", "points"), shown="omission")
    rows += [{"shown": "bound", "error_joint_pct": panel.bound_pct}] if panel.bound_pct else []
    return [{"panel": panel.title} | row for row in rows]


def panels_of(comparison, results):
    """The mean over all evaluated poses first, then the limb, then the rest."""
    folder = results / "work_precision"
    found = {name: records.table(folder / f"{name}.csv", columns) for name, columns in tables.items()}
    found["omissions"] = omission_boxes.read(results)
    cases, shown = omission_boxes.points_of(results, point_columns), []
    for case in dict.fromkeys(row["case"] for row in found["fronts"] if row["comparison"] == comparison):
        rows = cases.get(case, [])
        if not rows or rows[0]["half"] != "training":
            title = case_words.posed(rows[0]) if rows else case.replace("_", " ")
            shown.append(Panel(comparison, case, title, rows, found))
    shown = [panel for panel in shown if panel.fronts]
    records.need(shown, f"{folder}: no evaluated pose with a reference in {comparison}")
    return sorted(shown, key=lambda panel: ("evaluated" not in panel.title, not panel.title.startswith("limb"),
                                            "mean" in panel.title))[:most_panels]


def draw_comparison(comparison, results):
    shown = panels_of(comparison, results)
    columns = min(2, len(shown))
    figure, axes = style.panels(-(-len(shown) // columns), columns, height_in=4.2 if len(shown) < 3 else 3.4, width_in=style.page_in)
    for axes_of_panel, panel in zip(axes.flat, shown):
        draw_panel(axes_of_panel, panel)
    for axes_of_panel in axes.flat[len(shown):]:
        axes_of_panel.set_visible(False)
    axes.flat[0].plot([], [], linestyle="none", marker="o", color="#777777", markersize=2.2, alpha=0.4, label="small marks: all settings")
    words = {"own": "time as the program states it", "wall": "wall time of the program over its poses"}
    clocks = dict.fromkeys(f"{row['deformer']}: {words[row['clock']]}" for panel in shown for row in panel.points
                           if row.get("clock") in words)  # deformers of the user's own whose time is not processor time
    for note in ("above a line: the class nearest within that time", "or n more: not decided against these classes", *clocks):
        axes.flat[0].plot([], [], linestyle="none", label=note)
    style.legend_above(figure, columns=3)
    return figure, [row for panel in shown for row in rows_behind(panel)]


def work_precision(results):
    return draw_comparison("packed_f32", results)


def work_precision_plain(results):
    return draw_comparison("plain_f64", results)


# Data profiles (More and Wild 2009): the share of the evaluated poses that a group of deformers solves to 10, 5 and 2 % within a time per
# frame, for packed f32 code (above) and plain f64 code (below). The omissions of both are listed below them.

profile_columns = ("comparison", "tolerance_pct", "group", "ms", "solved", "certain", "poses", "share_pct")
tolerances_pct = (10.0, 5.0, 2.0)


def draw_profiles(axes, rows, span_ms):
    """A group's share rises at each of its rows; curves that coincide are drawn slightly apart."""
    groups = looks.in_order({row["group"] for row in rows})
    for place, group in enumerate(groups):
        steps = [row for row in rows if row["group"] == group]
        ms, share = records.numbers(steps, "ms"), records.numbers(steps, "share_pct")
        apart = 0.5 * (place - (len(groups) - 1) / 2)
        axes.step([ms[0], *ms, span_ms[1]], [apart, *(value + apart for value in share), share[-1] + apart], where="post",
                  **style.as_of(group, linestyle="-", markersize=2.8, markevery=list(range(1, len(ms) + 1)), linewidth=1.0))


def omitted_in(results, rows, comparison):
    """The omissions of the evaluated poses, and per tolerance the groups without a curve because they solve no pose."""
    evaluated = [case for case, of in omission_boxes.points_of(results, {"half"}).items() if of[0]["half"] == "evaluation"]
    lines = omission_boxes.lines(omission_boxes.added_up(results, comparison, evaluated))
    fronts = records.table(results / "work_precision" / "fronts.csv", {"comparison", "front"})
    known = {looks.group_of(row["front"]) for row in fronts if row["comparison"] == comparison and row["front"] != "all"}
    for tolerance_pct in tolerances_pct:
        drawn = {row["group"] for row in rows if float(row["tolerance_pct"]) == tolerance_pct}
        without = [looks.short(group) for group in looks.in_order(known - drawn)]
        lines += [f"no pose solved to {tolerance_pct:g} %: {', '.join(without)}"] if without else []
    return lines


def data_profiles(results):
    rows = records.table(results / "work_precision" / "data_profiles.csv", set(profile_columns))
    times = records.numbers(rows, "ms")
    span_ms = (min(times) / 1.5, max(times) * 1.5)
    of_comparison = {name: [row for row in rows if row["comparison"] == name] for name in comparisons}
    shown = {name: found for name, found in of_comparison.items() if found}
    figure, lines_of_axes = style.stacked(*[(len(tolerances_pct), 2.1), (1, 0.9)] * len(shown))
    behind = style.taken(rows, profile_columns)
    for (comparison, found), panels, (below,) in zip(shown.items(), lines_of_axes[::2], lines_of_axes[1::2]):
        for tolerance_pct, panel in zip(tolerances_pct, panels):
            draw_profiles(panel, [row for row in found if float(row["tolerance_pct"]) == tolerance_pct], span_ms)
            style.decades(panel.xaxis)
            panel.set(xlim=span_ms, ylim=(-4, 104), title=f"{comparisons[comparison]}, error at most {tolerance_pct:g} %",
                      xlabel="time per frame [ms]")
        panels[0].set_ylabel(f"solved poses [% of {rows[0]['poses']}]")
        omitted = omitted_in(results, found, comparison)
        omission_boxes.draw_below(below, omitted, 165)
        behind += [{"comparison": comparison, "omission": line} for line in omitted]
    style.legend_above(figure, columns=4)
    return figure, behind
