"""The finite element reference against theory: errors of a manufactured solution against the cell size, with the
theoretical slopes; the stiffness in bending and torsion that remains as Poisson's ratio approaches 1/2; and the
difference of every benchmark from its reference on the finest mesh."""
import records
from drawing import style
from words import case_words
from words.number_words import figure, span

# Element order and formulation.
looks = {("1", "displacement"): (style.rose, "v"), ("2", "displacement"): (style.indigo, "o"),
         ("2", "mean_dilatation"): (style.sand, "s"), ("2", "taylor_hood"): (style.teal, "D")}
norms = {"error_l2": ("$L^2$", "-", 1), "error_h1_seminorm": ("$H^1$", (0, (4, 1.5)), 0)}


def solved_with(rows, elements):
    """The rows with this element order and formulation."""
    return [row for row in rows if (row["element_order"], row["formulation"]) == elements]


def theory(ladder, order):
    """The rows with the errors that this order predicts, based on the error of the finest mesh."""
    finest_mesh = ladder[-1]
    return [{**row, "quantity": f"{row['quantity']}_by_theory", "expected_order": order,
             "value": float(finest_mesh["value"]) * (float(row["h_m"]) / float(finest_mesh["h_m"])) ** order}
            for row in ladder]


def draw_convergence(axes, rows):
    """One line per norm and element order; the theoretical slope is dotted from its finest to its coarsest mesh.
    Returns the dotted rows."""
    dotted = []
    for element_order in (1, 2):
        elements = str(element_order), "displacement"
        color, marker = looks[elements]
        for quantity, (norm, line, gain) in norms.items():
            ladder = [row for row in solved_with(rows, elements) if row["quantity"] == quantity]
            records.need(ladder, f"verification.csv: no {quantity} of elements of order {element_order}")
            order = element_order + gain
            style.plot(axes, ladder, "h_m", "value", color=color, linestyle=line, marker=marker,
                       label=f"{case_words.elements(*elements)} in {norm}, theory $h^{order}$")
            dotted += theory(ladder, order)
            style.plot(axes, dotted[-len(ladder):], "h_m", "value", color=style.ink, linestyle=(0, (1, 2)),
                       linewidth=0.7)
    axes.set_xscale("log", base=2)
    axes.set(yscale="log", xlabel="cell size over the cube's side", ylabel="error over the solution's norm",
             title="manufactured solution; dotted: theory")
    return dotted


def shown_of(row):
    """The members of a row that the locking panel and the CSV show."""
    distance = 1.0 - 2.0 * float(row["poisson"]) if row["element_order"] else 0.0  # volume constraints: nu = 1/2
    return {"one_less_two_nu": distance, "value_over_reference": float(row["value"]) / float(row["reference"])}


def draw_locking(axes, rows):
    """The value relative to the reference, against the distance to incompressibility."""
    for quantity, line in (("tip_deflection", "-"), ("torque", (0, (4, 1.5)))):
        for elements, (color, marker) in looks.items():
            ladder = [row for row in solved_with(rows, elements) if row["quantity"] == quantity]
            if ladder:
                distance, ratio = zip(*(shown_of(row).values() for row in ladder))
                label = case_words.elements(*elements) if line == "-" else None
                axes.plot(distance, ratio, color=color, linestyle=line, marker=marker, label=label)
    kept = [row for row in rows if (row["formulation"], row["quantity"]) == ("volume_constraints", "tip_deflection")]
    if kept:  # nu = 1/2 lies beyond a logarithmic axis, so it is a line
        axes.axhline(shown_of(kept[-1])["value_over_reference"], color=style.wine, linestyle=(0, (1, 1)),
                     label="constraints of PBS")
    axes.axhline(1.0, color=style.ink, linewidth=0.6)
    axes.set(xscale="log", ylim=(0.0, 1.65), xlabel="1 \u2212 2 \u03bd, from compressible to incompressible",
             ylabel="value over theory", title="locking: bending (full lines), torsion (dashed)")
    axes.invert_xaxis()


def finest(rows):
    """For each benchmark, Poisson's ratio and element, the row with the most degrees of freedom."""
    chosen = {}
    for row in rows:
        key = (row["problem"], row["quantity"], row["poisson"], row["element_order"], row["formulation"])
        if name_of(row) and row["difference_pct"] and (key not in chosen
                                                       or int(row["dofs"]) > int(chosen[key]["dofs"])):
            chosen[key] = row
    return list(chosen.values())


def name_of(row):
    """The benchmark in words; none for other quantities."""
    return case_words.tables["benchmark"].get(row["problem"], {}).get(row["quantity"])


def label_of(row):
    return f"{name_of(row)}, \u03bd\u00a0=\u00a0{float(row['poisson']):.4g}"


def draw_benchmarks(axes, rows):
    places = {label: place for place, label in enumerate(dict.fromkeys(label_of(row) for row in rows))}
    axes.axvspan(-2.0, 2.0, color=style.pale, linewidth=0, zorder=0)
    axes.axvline(0.0, color=style.ink, linewidth=0.6)
    for elements, (color, marker) in looks.items():
        shown = solved_with(rows, elements)
        if shown:
            axes.plot(records.numbers(shown, "difference_pct"), [places[label_of(row)] for row in shown], color=color,
                      marker=marker, linestyle="none", label=case_words.elements(*elements), markersize=4.5)
    axes.set_xscale("symlog", linthresh=2.0, linscale=1.5)
    ticks = [-50, -10, -2, -1, 0, 1, 2, 10, 50]
    axes.set_xticks(ticks, [f"{tick:+g}".replace("-", "\u2212") if tick else "0" for tick in ticks])
    style.name_rows(axes, list(places))
    axes.set(xlim=(-70, 70), xlabel="difference from the reference on the finest mesh [%]",
             title="benchmarks; grey: grade A of MacNeal and Harder (1985)")


def verification_facts(rows):
    """How much of a beam's bending quadratic and linear elements keep as it becomes incompressible, and their largest
    benchmark difference [%]."""
    def of(order, rows):
        return [row for row in rows if row["element_order"] == str(order)]

    bent = [row for row in rows if (row["problem"], row["quantity"]) == ("locking", "tip_deflection")]
    judged = [row for row in rows if name_of(row) and row["difference_pct"]]
    kept = {f"p{order}_bending": span([100 * float(row["value_over_reference"]) for row in of(order, bent)])
            for order in (1, 2)}
    off = {f"p{order}_off": figure(max((abs(float(row["difference_pct"])) for row in of(order, judged)), default=None))
           for order in (1, 2)}
    return kept | off


def verification(results):
    rows = records.table(results / "verification" / "verification.csv",
                         {"problem", "quantity", "element_order", "formulation", "poisson", "h_m", "dofs", "value",
                          "reference", "difference_pct"})
    manufactured, locking = ([row for row in rows if row["problem"] == name]
                             for name in ("manufactured_solution", "locking"))
    shown = finest(rows)
    records.need(shown, "verification.csv: no benchmark")
    drawing, (above, below) = style.stacked((2, 2.2), (1, 4.4))
    dotted = draw_convergence(above[0], manufactured)
    draw_locking(above[1], locking)
    draw_benchmarks(below[0], shown)
    style.key_below(drawing)
    behind = [row | {"one_less_two_nu": "", "value_over_reference": ""} for row in manufactured + dotted + shown]
    behind += [row | shown_of(row) for row in locking]
    return drawing, behind
