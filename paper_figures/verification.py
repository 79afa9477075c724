"""The finite element reference against theory: errors of a manufactured solution against the cell size with the slopes they should have,
and every benchmark's difference from its reference on the finest mesh, by element order."""
import math

import records
import style

looks = {"P1": (style.vermillion, "v"), "P2": (style.blue, "o")}
norms = {"error in L2 over that of the solution": ("L2", "-", 1), "error in the H1 seminorm over that of the solution": ("H1", (0, (4, 1.5)), 0)}
labels = {
    ("cantilever", "tip deflection"): "cantilever, tip",
    ("gravity_cantilever", "deflection of the end's middle"): "cantilever, own weight",
    ("torsion", "torque"): "torsion of a square bar",
    ("thick_sphere", "radial displacement of the inner surface"): "Lam\u00e9's sphere",
    ("thick_plate", "sigma_yy at D"): "NAFEMS LE10, stress",
}


def look_of(elements):
    return looks.get(elements, (style.purple if "dilatation" in elements else style.green, "D"))


def draw_convergence(axes, rows):
    """One line a norm and element order; from its finest mesh the slope of theory, dotted, to the coarsest."""
    for elements, (color, marker) in looks.items():
        for quantity, (norm, line, gain) in norms.items():
            ladder = [row for row in rows if row["elements"] == elements and row["quantity"] == quantity]
            h, error = records.numbers(ladder, "h_m"), records.numbers(ladder, "value")
            order = int(elements[1]) + gain
            axes.plot(h, error, color=color, linestyle=line, marker=marker, label=f"{elements}, {norm}: h^{order}")
            axes.plot(h, [error[-1] * (x / h[-1]) ** order for x in h], color=style.black, linestyle=(0, (1, 2)), linewidth=0.7)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xlabel("cell size h [m]")
    axes.set_ylabel("error over the solution's norm")
    axes.set_title("manufactured solution; dotted: theory")
    axes.legend(loc="upper left")


def label_of(row):
    quantity = labels.get((row["problem"], row["quantity"]), row["quantity"].split(" (")[0])
    return f"{quantity}, {row['material'].split('nu = ')[-1]}"


def finest(rows):
    """Of each quantity with a reference, material and element order the row with the most degrees of freedom."""
    chosen = {}
    for row in rows:
        if not row["difference_pct"]:
            continue
        key = (row["problem"], row["quantity"], row["material"], row["elements"])
        if key not in chosen or int(row["dofs"]) > int(chosen[key]["dofs"]):
            chosen[key] = row
    return list(chosen.values())


def draw_benchmarks(axes, rows):
    places = {label: place for place, label in enumerate(dict.fromkeys(label_of(row) for row in rows))}
    for elements in dict.fromkeys(row["elements"] for row in rows):
        color, marker = look_of(elements)
        of_elements = [row for row in rows if row["elements"] == elements]
        axes.plot(records.numbers(of_elements, "difference_pct"), [places[label_of(row)] for row in of_elements], color=color, marker=marker,
                  linestyle="none", label=elements, markersize=4)
    axes.axvspan(-2.0, 2.0, color="#E8E8E8", linewidth=0, zorder=0, label="within 2 %: grade A (MacNeal, Harder 1985)")
    axes.axvline(0.0, color=style.black, linewidth=0.6)
    axes.set_xscale("symlog", linthresh=2.0, linscale=1.5)
    ticks = [-50, -10, -2, -1, 0, 1, 2, 10, 50]
    axes.set_xticks(ticks, [f"{tick:+g}".replace("-", "\u2212") if tick else "0" for tick in ticks])
    axes.set_xlim(-100, 100)
    axes.set_yticks(range(len(places)), list(places))
    axes.set_ylim(len(places) - 0.5, -0.5)
    axes.set_xlabel("difference from the reference [%], finest mesh")
    axes.set_title("benchmarks, with Poisson's ratio")
    axes.legend(loc="upper center", bbox_to_anchor=(0.4, -0.2), ncol=3)


def draw(results, figures):
    rows = records.table(results / "verification" / "verification.csv", {"problem", "quantity", "elements", "h_m", "value", "difference_pct"})
    manufactured = [row for row in rows if row["problem"] == "manufactured_solution"]
    benchmarks = [row for row in finest(rows) if math.isfinite(float(row["difference_pct"]))]
    if not manufactured or not benchmarks:
        raise records.RecordsMissing(f"{results / 'verification' / 'verification.csv'}: no manufactured solution or no benchmark")
    figure, axes = style.panels(1, 2, height_in=3.4, gridspec_kw={"width_ratios": [1, 1.15]})
    draw_convergence(axes[0][0], manufactured)
    draw_benchmarks(axes[0][1], benchmarks)
    style.save(figure, figures / "verification", records.provenance(results / "verification"), manufactured + benchmarks)
