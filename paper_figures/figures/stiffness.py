"""Force over displacement of flesh under its weight against iterations, time step and resolution. The stiffness of a material would be a
flat line. That of PBS grows with the iterations and falls with the square of the time step. The exponent of Mueller 2007 removes neither
dependence. XPBD, which keeps multipliers, is nearly flat. Values too stiff to move in double precision are left out."""
import sys

import records
from drawing import style
from records import entries
from words import looks
from words.number_words import figure, listed

bodies = [("bar", "cantilever", "bar, held at one end"), ("limb", "zone_on_held", "limb, flesh on a held core"),
          ("human", "zone_on_held", "human, flesh on a held core")]
factors = {"iterations": "iterations", "time_step_ms": "time step [ms]", "vertices": "vertices"}
usual = {"iterations": 24.0, "time_step_ms": 10.0}
young_pa = 30e3  # of XPBD; some sweeps also use stiffer values
stiffest_n_m = 1 / sys.float_info.epsilon  # beyond this, 1 N moves the flesh by less than double precision resolves at 1 m
# method, k_stretch, its look, words after its name, and whether it is drawn hollow
methods = [("pbs", 0.2, "pbs", ", k_stretch 0.2", False), ("pbs", 0.9, "pbs", ", k_stretch 0.9", True),
           ("exponent", 0.2, "pbs_exponent", "", False), ("xpbd", 0.2, "xpbd", ", 30 kPa", False),
           ("xpbd_small_steps", 0.2, "xpbd_small_steps", ", 30 kPa", True)]
columns = {"body", "load", "vertices", "mesh", "method", "k_stretch", "young_pa", "iterations", "time_step_ms", "order_seed", "by",
           "stiffness_n_m", "converged"}


def varied(rows, factor, method, k_stretch):
    """Rows by the linear response, in the first order of constraints. A row that did not converge or is not positive has no stiffness."""
    others = [name for name in usual if name != factor]
    rows = [row for row in rows if (row["method"], row["by"], row["order_seed"], row["converged"]) == (method, "linear", "0", "1")
            and float(row["k_stretch"]) == k_stretch and float(row["young_pa"]) == young_pa and float(row["stiffness_n_m"]) > 0
            and all(float(row[name]) == usual[name] for name in others)]
    return sorted({float(row[factor]): row for row in rows}.values(), key=lambda row: float(row[factor]))


def rows_of(folder, factor, body, load):
    name = {"time_step_ms": "time_step", "vertices": "resolution"}.get(factor, factor)
    return [row for row in records.table(folder / f"{name}_{body}" / "stiffness.csv", columns) if row["load"] == load]


def draw_panel(axes, rows, factor):
    behind, left_out = [], 0
    for method, k_stretch, deformer, setting, hollow in methods:
        found = varied(rows, factor, method, k_stretch)
        shown = [row for row in found if float(row["stiffness_n_m"]) <= stiffest_n_m]
        left_out += len(found) - len(shown)
        if shown:
            look = looks.of(deformer)
            axes.plot(records.numbers(shown, factor), records.numbers(shown, "stiffness_n_m"), color=look.color, marker=look.marker,
                      linestyle=looks.lines["dotted"] if hollow else look.line, markerfacecolor="none" if hollow else look.color,
                      label=look.name + setting)
        behind += [{"varied": factor} | {name: row[name] for name in sorted(columns)} for row in shown]
    values = sorted({float(row[factor]) for row in behind})
    axes.set_yscale("log")
    if left_out:
        axes.annotate(f"{left_out} stiffer, left out", (0.03, 0.9), xycoords="axes fraction", fontsize=6)
    if values:
        draw_factor_axis(axes.xaxis, factor, values)
    return behind


def draw_factor_axis(axis, factor, values):
    """Each setting by its number. Mesh sizes come in pairs that are nearly equal, whose labels would overlap."""
    if factor != "vertices":
        style.log_scale(axis, values)
    elif values[-1] < 30 * values[0]:
        style.log_scale(axis)
    else:
        style.decades(axis)


def stiffness_facts(rows):
    """The ratio by which XPBD stiffens over the iterations shown, plain and in small steps, and the values of the other settings."""
    def folds(method):
        parts = []
        for body, _, _ in bodies:
            shown = [row for row in rows if (row["body"], row["varied"], row["method"]) == (body, "iterations", method)]
            counts, found = ([float(row[name]) for row in shown] for name in ("iterations", "stiffness_n_m"))
            if len(shown) > 1:
                parts.append(f"{figure(found[-1] / found[0])}-fold ({body}, {figure(min(counts))} to {figure(max(counts))})")
        return listed(parts)

    held = {"iterations": figure(usual["iterations"]), "step_ms": figure(usual["time_step_ms"]),
            "k_exponent": listed([figure(k_stretch) for method, k_stretch, *_ in methods if method == "exponent"])}
    return {"xpbd": folds("xpbd"), "small_steps": folds("xpbd_small_steps")} | held


def stiffness(results, figures):
    folder = results / "stiffness"
    drawing, axes = style.panels(3, 3, height_in=1.6)
    behind = []
    for panels, (body, load, title) in zip(axes, bodies):
        for panel, (factor, name) in zip(panels, factors.items()):
            behind += draw_panel(panel, rows_of(folder, factor, body, load), factor)
            panel.set_title(title)
            panel.set_xlabel(name)
        panels[0].set_ylabel("stiffness [N/m]")
    style.legend_above(drawing, columns=3)
    style.save(drawing, figures / "stiffness", entries.origin_of(results, "stiffness"), behind)
