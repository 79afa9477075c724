"""Error against run time, one figure for packed f32 code and one for plain f64 code. One panel per evaluated pose, and one of their mean:
every setting of every deformer, the front of each group of deformers with the settings that were chosen on other poses, the deformer that
is nearest within 0.1, 1 and 10 ms, the bound on the reference's own error, below which differences have no meaning, and what is
omitted."""
import records
from drawing import omission_boxes, style
from records import compared_codes, entries
from words import case_words, looks

figures_of = {"packed_f32": "work_precision", "plain_f64": "work_precision_plain"}
case_columns = ("body", "motion", "pose", "angle_deg")
setting_columns = ("iterations", "k_stretch", "order", "precision", "substeps", "element_order", "wanted_vertices", "refined", "tuned",
                   "packed")
point_numbers = ("deformer", *setting_columns, "ms_median", "error_joint_pct")
front_columns = {"comparison", "case", "measure", "front", "reference_error_joint_pct", *point_numbers}
point_columns = {*case_columns, *point_numbers, "outcome", "half", "reach_ms", "reference_error_joint_pct"}
best_columns = {"comparison", "case", "budget_ms", "rank", "group", "decision", "undecided_against", "error_joint_pct", "ms_median"}
budgets_ms = (0.1, 1.0, 10.0)
most_panels = 6
most_named_groups = 3
name_row_height = 0.048  # of the height of a panel


def measured(rows):
    return [row for row in rows if row["ms_median"] and row["error_joint_pct"]]


class Panel:
    """One pose or mean in one comparison, with the rows behind it."""

    def __init__(self, comparison, case, title, points, tables):
        def of_case(table, **wanted):
            wanted = {"comparison": comparison, "case": case, **wanted}
            return [row for row in tables[table] if all(row[column] == value for column, value in wanted.items())]

        self.is_mean = not points
        self.title, self.points = title, compared_codes.taking_part(measured(points), comparison)
        self.fronts = of_case("fronts", measure="error_joint_pct")
        self.best = [row for row in of_case("best_within", rank="1") if float(row["budget_ms"]) in budgets_ms]
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
    for group in looks.in_order({looks.group_of(row["deformer"]) for row in panel.points + panel.fronts if row.get("front") != "all"}):
        look = looks.of(group)
        tried = [row for row in panel.points if looks.group_of(row["deformer"]) == group]
        if tried:
            axes.plot(records.numbers(tried, "ms_median"), records.numbers(tried, "error_joint_pct"), linestyle="none", marker=look.marker,
                      color=look.color, markersize=2.2, alpha=0.25, markeredgewidth=0.5)
        front = group_front([row for row in panel.fronts if row["front"] != "all" and looks.group_of(row["front"]) == group])
        if front:
            axes.plot(records.numbers(front, "ms_median"), records.numbers(front, "error_joint_pct"), color=look.color,
                      marker=look.marker, label=look.name, linewidth=1.0)
    front = [row for row in panel.fronts if row["front"] == "all"]
    if front:
        axes.step(records.numbers(front, "ms_median"), records.numbers(front, "error_joint_pct"), where="post", color=style.yellow,
                  linewidth=4.0, alpha=0.6, zorder=0, label="front of all")
    axes.set_xscale("log")
    axes.set_yscale("log")


def group_front(rows):
    """The front of a group from those of its deformers."""
    front, least = [], float("inf")
    for row in sorted(rows, key=lambda row: (float(row["ms_median"]), float(row["error_joint_pct"]))):
        if float(row["error_joint_pct"]) < least:
            least = float(row["error_joint_pct"])
            front.append(row)
    return front


def draw_bound(axes, bound_pct):
    low, high = axes.get_ylim()
    if bound_pct and bound_pct > low:
        axes.axhspan(low, min(bound_pct, high), color="#EFEFEF", linewidth=0, zorder=-1,
                     label="below the reference\u2019s own error (bound)")
    axes.set_ylim(low, high)


def draw_budgets(axes, panel):
    """A line at each budget, and above it the nearest deformer with its error. Each name has a row of its own: the lines are too close
    together for several in one row."""
    for place, row in enumerate(panel.best):
        budget_ms = float(row["budget_ms"])
        against = row["undecided_against"].split()
        mark = "" if row["decision"] in ("decided", "") else f"? ({len(against)})"
        axes.axvline(budget_ms, color="#777777", linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
        axes.text(budget_ms, 1.01 + name_row_height * place,
                  f"{budget_ms:g} ms: {looks.short(row['group'])}{mark}, {float(row['error_joint_pct']):.3g} %",
                  transform=axes.get_xaxis_transform(), ha="center", va="bottom", fontsize=5.2, color=looks.of(row["group"]).color)


def undecided_lines(panel):
    """within 10 ms against: XPBD, quasi-Newton. The names of many groups would hide the points; their number stands above the line, and
    the table behind the figure names them."""
    lines = []
    for row in panel.best:
        groups = row["undecided_against"].split()
        if 0 < len(groups) <= most_named_groups:
            names = ", ".join(looks.short(group) for group in groups)
            lines.append(f"within {float(row['budget_ms']):g} ms against: {names}")
    return lines


def draw_omissions(axes, panel):
    rule = ["settings without an error in one of the poses"] if panel.is_mean else []
    omission_boxes.draw(axes, rule + omission_boxes.lines(panel.omitted), 46, undecided_lines(panel))


def draw_panel(axes, panel):
    draw_points(axes, panel)
    low, high = axes.get_ylim()
    axes.set_ylim(low / (high / low) ** 0.28, high)  # room for the omissions
    draw_bound(axes, panel.bound_pct)
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis)
    axes.set_title(panel.heading(), pad=30)
    axes.set_xlabel("processor time per frame [ms]")
    axes.set_ylabel("error at the joints [%]")
    draw_budgets(axes, panel)
    draw_omissions(axes, panel)


def rows_behind(panel):
    """Points, fronts, the nearest within each budget, omissions and the bound, as rows of one table."""
    def taken(row, names):
        return {name: row[name] for name in names}

    rows = [{"shown": "point"} | taken(row, point_numbers) for row in panel.points]
    rows += [{"shown": f"front of {row['front']}"} | taken(row, point_numbers) for row in panel.fronts]
    rows += [{"shown": "nearest"} | taken(row, ("budget_ms", "group", "decision", "undecided_against", "ms_median", "error_joint_pct"))
             for row in panel.best]
    rows += [{"shown": "omission"} | taken(row, ("deformer", "why", "missing", "points")) for row in panel.omitted]
    if panel.bound_pct:
        rows.append({"shown": "bound", "error_joint_pct": panel.bound_pct})
    return [{"panel": panel.title} | row for row in rows]


def place(title):
    """The mean over all evaluated poses first, then the limb, then the rest."""
    return "evaluated" not in title, not title.startswith("limb"), "mean" in title


def panels_of(comparison, results):
    folder = results / "work_precision"
    tables = {name: records.table(folder / f"{name}.csv", columns) for name, columns in
              (("fronts", front_columns), ("best_within", best_columns))}
    tables["omissions"] = omission_boxes.read(results)
    cases = {file.parent.name: records.table(file, point_columns) for file in sorted(folder.glob("*/points.csv"))}
    shown = []
    for case in dict.fromkeys(row["case"] for row in tables["fronts"] if row["comparison"] == comparison):
        rows = cases.get(case, [])
        if rows and rows[0]["half"] == "training":
            continue
        shown.append(Panel(comparison, case, case_words.posed(rows[0]) if rows else case.replace("_", " "), rows, tables))
    shown = [panel for panel in shown if panel.fronts]
    if not shown:
        raise records.RecordsMissing(f"{folder}: no evaluated pose with a reference in {comparison}")
    return sorted(shown, key=lambda panel: place(panel.title))[:most_panels]


def clock_notes(shown):
    """A line for each deformer of the user's own whose time is not processor time."""
    words = {"own": "time as the program states it", "wall": "wall time of the program over its poses"}
    clocks = {(row["deformer"], row["clock"]): None for panel in shown for row in panel.points if row.get("clock") in words}
    return [f"{deformer}: {words[clock]}" for deformer, clock in clocks]


def draw_comparison(comparison, results, figures):
    shown = panels_of(comparison, results)
    columns = min(2, len(shown))
    figure, axes = style.panels(-(-len(shown) // columns), columns, height_in=3.2, width_in=style.page_in)
    for axes_of_panel, panel in zip(axes.flat, shown):
        draw_panel(axes_of_panel, panel)
    for axes_of_panel in axes.flat[len(shown):]:
        axes_of_panel.set_visible(False)
    axes.flat[0].plot([], [], linestyle="none", marker="o", color="#777777", markersize=2.2, alpha=0.4, label="small marks: all settings")
    notes = ("name above a line: nearest within that time", "? (n): the references do not decide against n groups", *clock_notes(shown))
    for note in notes:
        axes.flat[0].plot([], [], linestyle="none", label=note)
    style.legend_above(figure, columns=3)
    name = figures_of[comparison]
    behind = [row for panel in shown for row in rows_behind(panel)]
    style.save(figure, figures / name, entries.origin_of(results, name), style.aligned(behind))


def work_precision(results, figures):
    draw_comparison("packed_f32", results, figures)


def work_precision_plain(results, figures):
    draw_comparison("plain_f64", results, figures)
