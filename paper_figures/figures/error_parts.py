"""The error of PBS in each pose of the study of error against run time, split into three parts over the iterations: the solver's part, the
part of the converged constraints, and the bound on the reference's own discretisation error. Where the bound exceeds the whole error, the
reference is too coarse to measure the error of PBS. The poses and points that are missing are listed below."""
import records
from drawing import omission_boxes, style
from figures import error_split
from records import entries
from words import case_words

case_columns = ("body", "motion", "pose", "angle_deg")
columns = {*case_columns, "deformer", "iterations", "k_stretch", "order", "precision", "substeps", "wanted_vertices",
           *(column for column, *_ in error_split.parts)}
most_panels = 4


def of_pbs(rows, k_stretch):
    chosen = [row for row in rows if (row["deformer"], row["order"], row["precision"]) == ("pbs", "ordered", "f32")
              and float(row["k_stretch"]) == k_stretch and row["solver_pct"] and row["substeps"] == "1"
              and not row["wanted_vertices"]]
    return sorted(chosen, key=lambda row: int(row["iterations"]))


def draw_case(axes, rows):
    behind = []
    for column, label, color, marker, line in error_split.parts:
        if not any(row[column] for row in rows):  # a reference without a bound
            continue
        iterations, values = records.numbers(rows, "iterations"), records.numbers(rows, column)
        axes.plot(iterations, values, color=color, marker=marker, linestyle=line, label=label)
        of_case = {name: rows[0][name] for name in case_columns}
        behind += [of_case | {"part": column, "iterations": i, "value_pct": v} for i, v in zip(iterations, values)]
    axes.axvline(24, color=style.black, linewidth=0.6)
    style.log_scale(axes.xaxis, [1, 4, 24, 96, 384])
    style.log_scale(axes.yaxis)
    axes.set_title(case_words.posed(rows[0]))
    axes.set_xlabel("iterations; line: the paper's 24")
    axes.set_ylabel("error at the joints [%]")
    return behind


def omitted_lines(results, tables, shown):
    """The poses that are not among those shown, and the points of PBS that are missing in those."""
    def names(cases):
        return "; ".join(case_words.posed(tables[case][0]) for case in cases)  # a name has commas

    without = [case for case, rows in tables.items() if not of_pbs(rows, 0.2)]
    further = [case for case in tables if case not in shown and case not in without]
    lines = [f"no parts of the error on record: {names(without)}"] if without else []
    lines += [f"at most {most_panels} poses are shown, without {names(further)}"] if further else []
    missing = [row for row in omission_boxes.added_up(results, "packed_f32", (*shown, *without)) if row["deformer"] == "pbs"]
    return lines + omission_boxes.lines(missing)


def error_parts(results, figures):
    folder = results / "work_precision"
    tables = {file.parent.name: records.table(file, columns) for file in sorted(folder.glob("*/points.csv"))}
    cases = [case for case, rows in tables.items() if of_pbs(rows, 0.2)]
    cases = sorted(cases, key=lambda case: tables[case][0]["body"] != "limb")[:most_panels]
    if not cases:
        raise records.RecordsMissing(f"{folder}: no case with the error split")
    lines = -(-len(cases) // 2)
    figure, rows_of_axes = style.stacked(*[(2, 2.1)] * lines, (1, 0.6))
    panels = [panel for line in rows_of_axes[:-1] for panel in line]
    behind = [row for panel, case in zip(panels, cases) for row in draw_case(panel, of_pbs(tables[case], 0.2))]
    for panel in panels[len(cases):]:
        panel.set_visible(False)
    omitted = omitted_lines(results, tables, cases)
    omission_boxes.draw_below(rows_of_axes[-1][0], omitted, 170)
    style.legend_above(figure, columns=4)
    style.save(figure, figures / "error_parts", entries.origin_of(results, "error_parts"),
               style.aligned(behind + [{"omission": line} for line in omitted]))
