"""Error against run time, for packed f32 code and for plain f64 code: which class of deformers is nearest within which time, and the share
of the poses that each class solves within a time."""
import textwrap

import records
from drawing import style
from words import case_words, looks
from words.number_words import span

comparisons = {"packed_f32": "packed f32 code", "plain_f64": "plain f64 code"}

# One panel per evaluated pose, and one of their mean. Each class of deformers has the front of its settings that were chosen on other
# poses, and everything else is grey. The line below a panel names the class that is nearest within 0.1, 1 and 10 ms.

point_numbers = ("deformer", "iterations", "k_stretch", "order", "precision", "substeps", "element_order", "wanted_vertices", "refined",
                 "tuned", "packed", "ms_median", "error_joint_pct")
tables = {"fronts": {"comparison", "case", "front", "reference_error_joint_pct", *point_numbers},
          "nearest": {"comparison", "case", "budget_ms", "among", "nearest", "deformer", "knows", "either_of", "error_joint_pct",
                      "ms_median"}}
point_columns = {"body", "motion", "pose", "angle_deg", *point_numbers, "outcome", "half", "reach_ms", "reference_error_joint_pct"}
omission_columns = {"comparison", "case", "deformer", "why", "missing", "points", "reason"}
most_panels = 4


def code_rank(row):
    """The better code has the higher rank: packed f32, plain f32, packed f64, plain f64. A deformer of the user's own has no precision on
    record and takes part in both comparisons."""
    return 2 * (row["precision"] == "f32") + (row["packed"] == "1")


def taking_part(rows, comparison):
    """The points of a comparison: in plain_f64 those of plain f64 code, in packed_f32 those of the best code of each deformer."""
    best = {}
    for row in rows if comparison != "plain_f64" else []:
        best[row["deformer"]] = max(best.get(row["deformer"], 0), code_rank(row))
    return [row for row in rows if code_rank(row) == best.get(row["deformer"], 0)]


def omissions_of(folder):
    """The rows of omissions.csv. A record without omissions has none."""
    file = folder / "omissions.csv"
    return records.table(file, omission_columns) if records.read_rows(file) else []


def points_of(results, needed):
    """The points of each case."""
    return {file.parent.name: records.table(file, needed) for file in sorted((results / "work_precision").glob("*/points.csv"))}


class Panel:
    """One pose or mean in one comparison, with the rows behind it."""

    def __init__(self, comparison, case, title, points, found):
        def of_case(table):
            return [row for row in found[table] if (row["comparison"], row["case"]) == (comparison, case)]

        self.title = title
        self.points = taking_part([row for row in points if row["ms_median"] and row["error_joint_pct"]], comparison)
        self.fronts = of_case("fronts")
        self.nearest, self.omitted = of_case("nearest"), of_case("omissions")
        bound = next((row["reference_error_joint_pct"] for row in self.fronts), "")
        self.bound_pct = float(bound) if bound else None
        self.reference = [row for row in points if row["outcome"] == "reference"][:1]

    def front_of(self, name):
        """The front of a class from those of its deformers, or that of all."""
        front, least = [], float("inf")
        rows = [row for row in self.fronts if name == (row["front"] if name == "all" else looks.class_of(row["front"]))]
        for row in sorted(rows, key=lambda row: (float(row["ms_median"]), float(row["error_joint_pct"]))):
            if float(row["error_joint_pct"]) < least:
                least = float(row["error_joint_pct"])
                front.append(row)
        return front

    def classes(self):
        return looks.in_order({looks.class_of(row["front"]) for row in self.fronts} - {"all"}, looks.classes)


def words_of_class(name):
    """The class; a deformer of the user's own is a class by itself."""
    return case_words.of_field("class", name)


def draw_class(axes, panel, name):
    """The front of a class; a filled mark is on the front of all. Returns the last row of the front, and the name of the class with the
    deformers on its front and their markers."""
    front, color, at = panel.front_of(name), looks.color_of_class(name), ("ms_median", "error_joint_pct")
    best = {tuple(row[column] for column in ("deformer", *at)) for row in panel.front_of("all")}
    style.plot(axes, front, *at, color=color, linewidth=1.0, gid="guide")
    for row in front:
        method = looks.group_of(row["deformer"])
        fill = color if tuple(row[column] for column in ("deformer", *at)) in best else "white"
        style.plot(axes, [row], *at, color=color, marker=looks.of(method).marker, markerfacecolor=fill, markersize=4, linestyle="none",
                   markeredgewidth=0.7, label=f"{looks.short(method)}, {words_of_class(name)}")
    methods = {method: looks.glyphs.get(looks.of(method).marker, looks.of(method).marker)
               for method in looks.in_order({looks.group_of(row["deformer"]) for row in front})}
    marked = ", ".join(f"{glyph} {looks.short(method)}".replace(" ", "\u00a0") for method, glyph in methods.items())
    by_itself = {looks.short(method) for method in methods} <= {name, words_of_class(name)} and len(methods) == 1
    return front[-1], textwrap.fill(marked if by_itself else f"{words_of_class(name)}: {marked}", 34)


def answer(panel, row):
    """0.1 ms: blending (DQS diffused). The deformer is named if it is decided within its class."""
    classes = [row["nearest"], *row["either_of"].split()]
    of_class = [other for other in panel.nearest if (other["budget_ms"], other["among"]) == (row["budget_ms"], row["nearest"])]
    decided = len(classes) == 1 and all(not other["either_of"] for other in of_class)
    named = " or ".join(map(words_of_class, classes)) if len(classes) < 3 else f"undecided ({words_of_class(row['nearest'])} nearest)"
    return f"{float(row['budget_ms']):g} ms: {named}" + (f" ({looks.short(row['deformer'])})" if decided else "")


def draw_panel(axes, panel):
    """A dotted line leads from the end of each front to its label. Returns the labels by line."""
    axes.set(xscale="log", yscale="log", title=panel.title, ylabel="error at the joints [%]")
    if panel.points:  # a mean has none
        style.plot(axes, panel.points, "ms_median", "error_joint_pct", color=style.light, marker="o", markersize=1.4, linestyle="none",
                   label="another setting")
    ends = {name: draw_class(axes, panel, name) for name in panel.classes()}
    (low, high), (first_ms, last_ms) = axes.get_ylim(), axes.get_xlim()
    if panel.bound_pct and panel.bound_pct > low:
        axes.axhspan(low, min(panel.bound_pct, high), color=style.pale, linewidth=0, zorder=-1)
        style.name_area(axes, "below the reference\u2019s own error", (0.005, min(panel.bound_pct, high)), va="top")
    axes.set(xlim=(first_ms, last_ms), ylim=(low, high))
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis)
    answers = [row for row in panel.nearest if row["among"] == "classes"]
    for row in answers:
        axes.axvline(float(row["budget_ms"]), color=style.grey, linewidth=0.7, linestyle=(0, (2, 2)), zorder=0)
    axes.set_xlabel("processor time per frame [ms]\n" + " | ".join(answer(panel, row) for row in answers), loc="left")
    return {axes.plot([float(row["ms_median"]), last_ms], [float(row["error_joint_pct"])] * 2, color=looks.color_of_class(name),
                      linewidth=0.5, linestyle=(0, (1, 2)), gid="guide")[0]: text for name, (row, text) in ends.items()}


def rows_behind(panel):
    """Points, fronts, the nearest within each budget, omissions, the reference and its bound, as rows of one table."""
    of_point = [*point_numbers, *(name for name in ("skin_rms_mm", "clock") if panel.points and name in panel.points[0])]
    rows = style.taken(panel.points, of_point, shown="point")
    rows += [row for front in panel.fronts for row in style.taken([front], point_numbers, shown=f"front of {front['front']}")]
    of_nearest = ("budget_ms", "among", "nearest", "deformer", "knows", "either_of", "ms_median", "error_joint_pct")
    rows += [of for row in panel.nearest for of in style.taken(
        [row], of_nearest, shown="nearest" if row["among"] == "classes" else "nearest of its class")]
    rows += style.taken(panel.omitted, ("deformer", "why", "missing", "points", "reason"), shown="omission")
    rows += [{"shown": "reference", "ms_median": row["reach_ms"]} for row in panel.reference]
    rows += [{"shown": "bound", "error_joint_pct": panel.bound_pct}] if panel.bound_pct else []
    return [{"panel": panel.title} | row for row in rows]


def panels_of(comparison, results):
    """The mean over all evaluated poses first, then the limb, then the rest."""
    folder = results / "work_precision"
    found = {name: records.table(folder / f"{name}.csv", columns) for name, columns in tables.items()}
    found["omissions"] = omissions_of(folder)
    cases, shown = points_of(results, point_columns), []
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
    figure, axes = style.panels(len(shown), 1, height_in=2.9 if len(shown) == 1 else 2.4, width_in=style.page_in)
    labels = {axes_of_panel: draw_panel(axes_of_panel, panel) for axes_of_panel, panel in zip(axes.flat, shown)}
    for axes_of_panel, texts in labels.items():
        style.label_ends(axes_of_panel, texts)
    return figure, [row for panel in shown for row in rows_behind(panel)]


def work_precision(results):
    return draw_comparison("packed_f32", results)


def work_precision_plain(results):
    return draw_comparison("plain_f64", results)


def work_precision_facts(rows):
    """The time of the reference, the omitted points, and the clocks of deformers whose time is not processor time."""
    words = {"own": "time as the program states it", "wall": "wall time of the program over its poses"}
    clocks = dict.fromkeys(f" {row['deformer']}: {words[row['clock']]}." for row in rows if row.get("clock") in words)
    omitted = sum(int(row["missing"]) for row in rows if row["shown"] == "omission" and row["missing"])
    return {"reference_s": span([float(row["ms_median"]) / 1e3 for row in rows if row["shown"] == "reference"]),
            "omitted": omitted or "none", "clocks": "".join(clocks)}


work_precision_plain_facts = work_precision_facts


# Data profiles (More and Wild 2009): the share of the evaluated poses that a class solves to 10, 5 and 2 % within a time per frame, for
# packed f32 code (left) and plain f64 code (right). The share of a class is that of its best deformer at this time.

profile_columns = ("comparison", "tolerance_pct", "group", "ms", "solved", "certain", "poses", "share_pct")
tolerances_pct = (10.0, 5.0, 2.0)


def draw_profiles(axes, rows, span_ms):
    """The deformers in grey, and in colour the largest share of each class."""
    labels = {}
    for group in looks.in_order({row["group"] for row in rows}):
        steps = [row for row in rows if row["group"] == group]
        ms, share = records.numbers(steps, "ms"), records.numbers(steps, "share_pct")
        axes.step([ms[0], *ms, span_ms[1]], [0, *share, share[-1]], where="post", color=style.light, linewidth=0.6,
                  gid="guide")
        axes.plot(ms, share, **style.as_of(group, linestyle="", markersize=2))
    for name in looks.in_order({looks.class_of(row["group"]) for row in rows}, looks.classes):
        ms, share = [], [0.0]
        for row in sorted((row for row in rows if looks.class_of(row["group"]) == name), key=lambda row: float(row["ms"])):
            ms.append(float(row["ms"]))
            share.append(max(share[-1], float(row["share_pct"])))
        line, = axes.step([ms[0], *ms, span_ms[1]], [*share, share[-1]], where="post", color=looks.color_of_class(name),
                          label=words_of_class(name), gid="guide")
        labels[line] = words_of_class(name)
    if not rows:
        axes.annotate("no pose is solved", (0.5, 0.5), xycoords="axes fraction", ha="center")
    return labels


def omitted_in(results, rows, comparison):
    """The omissions of the evaluated poses, and per tolerance the groups without a curve because they solve no pose."""
    evaluated = {case for case, of in points_of(results, {"half"}).items() if of[0]["half"] == "evaluation"}
    omitted = [row for row in omissions_of(results / "work_precision") if row["comparison"] == comparison and row["case"] in evaluated]
    fronts = records.table(results / "work_precision" / "fronts.csv", {"comparison", "front"})
    known = {looks.group_of(row["front"]) for row in fronts if row["comparison"] == comparison and row["front"] != "all"}
    return omitted + [{"comparison": comparison, "tolerance_pct": tolerance_pct, "group": group, "why": "no pose solved"}
                      for tolerance_pct in tolerances_pct for group in looks.in_order(known - {
                          row["group"] for row in rows if float(row["tolerance_pct"]) == tolerance_pct})]


def data_profiles(results):
    rows = records.table(results / "work_precision" / "data_profiles.csv", set(profile_columns))
    times = records.numbers(rows, "ms")
    span_ms = (min(times) / 1.5, max(times) * 1.5)
    shown = [tolerance for tolerance in tolerances_pct if any(float(row["tolerance_pct"]) == tolerance for row in rows)]
    figure, axes = style.panels(len(shown), 2, height_in=1.7, sharex=True)
    behind, labels = style.taken(rows, profile_columns), {}
    for panels, (comparison, words) in zip(axes.T, comparisons.items()):
        found = [row for row in rows if row["comparison"] == comparison]
        for tolerance_pct, panel in zip(shown, panels):
            labels[panel] = draw_profiles(panel, [row for row in found if float(row["tolerance_pct"]) == tolerance_pct], span_ms)
            panel.set(ylim=(-4, 104), xlim=span_ms, title=f"{words}, error at most {tolerance_pct:g} %")
            style.decades(panel.xaxis)
        panels[-1].set_xlabel("processor time per frame [ms]")
        behind += omitted_in(results, found, comparison)
    style.label(axes, (), [f"solved poses [% of {rows[0]['poses']}]"] * len(shown))
    for panel, texts in labels.items():
        style.label_ends(panel, texts)
    return figure, behind
