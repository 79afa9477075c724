"""Error against run time, one panel per pose: every setting of every deformer, the front of each and the overall front, and the bound on
the reference's own error, below which differences have no meaning."""
import case_words
import entries
import records
import style

looks = {"lbs": (style.vermillion, "v"), "dqs": (style.orange, "s"), "delta_mush": (style.green, "^"), "pbs": (style.blue, "o"),
         "pbs_exponent": (style.sky, "p"), "xpbd": (style.purple, "D"), "xpbd_small_steps": ("#8B5A2B", "<"),
         "fem_linear": ("#999999", "x"), "fem_corotational": (style.black, "+"), "fem_neo_hookean": (style.black, "P")}
case_columns = ("body", "motion", "pose", "angle_deg")
setting_columns = ("iterations", "k_stretch", "order", "precision", "substeps", "element_order", "wanted_vertices", "refined")
point_numbers = ("deformer", *setting_columns, "ms_median", "error_joint_pct")
front_columns = {"case", "measure", "front", *point_numbers}
point_columns = {*case_columns, *point_numbers, "outcome", "reference_error_joint_pct"}
most_panels = 6


def measured(rows):
    return [row for row in rows if row["ms_median"] and row["error_joint_pct"]]


def draw_deformers(axes, rows, fronts):
    for deformer, (color, marker) in looks.items():
        chosen = [row for row in measured(rows) if row["deformer"] == deformer]
        if not chosen:
            continue
        axes.plot(records.numbers(chosen, "ms_median"), records.numbers(chosen, "error_joint_pct"), linestyle="none", marker=marker,
                  color=color, markersize=2.6, alpha=0.45, markeredgewidth=0.6)
        front = [row for row in fronts if row["front"] == deformer]
        axes.plot(records.numbers(front, "ms_median"), records.numbers(front, "error_joint_pct"), color=color, marker=marker,
                  label=case_words.of_field("deformer", deformer), linewidth=1.0)
    front = [row for row in fronts if row["front"] == "all"]
    if front:
        axes.step(records.numbers(front, "ms_median"), records.numbers(front, "error_joint_pct"), where="post", color=style.yellow,
                  linewidth=4.0, alpha=0.6, zorder=0, label="front of all")
    axes.set_xscale("log")
    axes.set_yscale("log")


def draw_bound(axes, bound):
    low, high = axes.get_ylim()
    if bound and float(bound) > low:
        axes.axhspan(low, min(float(bound), high), color="#EFEFEF", linewidth=0, zorder=-1, label="below the reference's own error (bound)")
    axes.set_ylim(low, high)


def draw_case(axes, case, rows, fronts):
    """Returns the rows behind it: points, fronts, and the bound on the reference's own error."""
    fronts = [row for row in fronts if row["case"] == case]
    bound = rows[0]["reference_error_joint_pct"]
    draw_deformers(axes, rows, fronts)
    draw_bound(axes, bound)
    style.log_scale(axes.yaxis)
    axes.set_title(case_words.posed(rows[0]) + (f"; bound {float(bound):.3g} %" if bound else ""))
    axes.set_xlabel("processor time per frame [ms]")
    axes.set_ylabel("error at the joints [%]")
    points = [{"shown": "point"} | {name: row[name] for name in point_numbers} for row in measured(rows)]
    of_fronts = [{"shown": f"front of {row['front']}"} | {name: row[name] for name in point_numbers} for row in fronts]
    levels = [{"shown": "bound", "error_joint_pct": bound}] if bound else []
    of_case = {name: rows[0][name] for name in case_columns}
    return [of_case | row for row in points + of_fronts + levels]


def place(rows):
    """The limb first, then the poses that the quick study also has, then the rest."""
    body, pose = rows[0]["body"], rows[0]["pose"]
    return body != "limb", (body, pose) not in (("human", "crouch"), ("human", "in_the_air"))


def draw(results, figures):
    folder = results / "work_precision"
    cases = [(file.parent.name, records.table(file, point_columns)) for file in sorted(folder.glob("*/points.csv"))]
    cases = [(case, rows) for case, rows in cases if measured(rows)]
    if not cases:
        raise records.RecordsMissing(f"{folder}: no case with a reference")
    cases.sort(key=lambda case: place(case[1]))
    fronts = [row for row in records.table(folder / "fronts.csv", front_columns) if row["measure"] == "error_joint_pct"]
    shown = cases[:most_panels]
    columns = 2
    figure, axes = style.panels(-(-len(shown) // columns), columns, height_in=2.4)
    behind = [row for panel, (case, rows) in zip(axes.flat, shown) for row in draw_case(panel, case, rows, fronts)]
    for panel in axes.flat[len(shown):]:
        panel.set_visible(False)
    axes.flat[0].plot([], [], linestyle="none", marker="o", color="#777777", markersize=2.6, alpha=0.45,
                      label="small marks: all settings; lines: the front of each deformer")
    style.legend_above(figure, columns=3)
    style.save(figure, figures / "work_precision", entries.origin_of(results, "work_precision"), style.aligned(behind))
