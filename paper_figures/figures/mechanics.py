"""How PBS moves flesh: the momentum that a projection changes, the response to a jolt, and the stiffness against the
settings of the solver."""
import sys

import records
from drawing import style
from words import looks
from words.number_words import figure, span

# The change of linear and angular momentum by one projection of a class of constraints, relative to the momentum
# exchanged. With weighted masses only rounding remains, in both precisions. The formulae for unit masses (Eq. 8-9) on
# unequal masses lose up to a third. The bind constraint transfers all of it to the bones, whose motion is prescribed.

quantities = {"linear_drift": "linear momentum", "angular_drift": "angular momentum",
              "linear_drift_taken_by_bones": "linear momentum", "angular_drift_taken_by_bones": "angular momentum"}
masses = {"equal": "equal masses", "unequal": "unequal masses, weighted", "unequal_by_eq_8_9": "unequal masses, Eq. "
                                                                                               "8\u20139"}
looks_of_drift = {("limb", "f32"): (style.rose, "v"), ("limb", "f64"): (style.rose, "^"),
                  ("human", "f32"): (style.indigo, "o"), ("human", "f64"): (style.indigo, "s")}


def drift_of(results, body):
    """One row per class of constraints, masses and precision, from single projections."""
    file = results / "momentum" / body / "measurements.csv"
    found = [{"momentum": quantities[row["quantity"]], "masses": row["masses"], "body": body,
              "constraints": row["constraint"], "precision": row["precision"], "drift": row["value"]}
             for row in records.table(file, {"quantity", "body", "masses", "constraint", "precision", "value"})
             if row["quantity"] in quantities and row["body"] == body]
    records.need(found, f"{file}: no drift of {body}")
    return found


def momentum_drift(results):
    rows = [row for body in ("limb", "human") for row in drift_of(results, body)]
    by_class = sorted(rows, key=lambda row: row["constraints"], reverse=True)
    places = {key: place
              for place, key in enumerate(dict.fromkeys((row["constraints"], row["masses"]) for row in by_class))}
    drawing, axes = style.panels(1, 2, height_in=3.4, sharey=True)
    for panel, momentum in zip(axes[0], ("linear momentum", "angular momentum")):
        for (body, precision), (color, marker) in looks_of_drift.items():
            shown = [row for row in rows if (row["momentum"], row["body"],
                                             row["precision"]) == (momentum, body, precision)]
            aside = 0.15 if precision == "f64" else -0.15
            panel.plot([float(row["drift"]) for row in shown], [places[row["constraints"], row["masses"]] + aside
                                                                for row in shown],
                       linestyle="none", marker=marker, color=color, label=f"{body}, {precision}", markersize=4.5,
                       markerfacecolor=color if precision == "f32" else "white")
        style.name_rows(panel, [f"{constraints}, {masses[of]}" for constraints, of in places])
        panel.set(xscale="log", xlabel="change over the momentum exchanged [1]", title=momentum)
    style.key_below(drawing)
    return drawing, rows


# Frequency and damping ratio of the first swing after a jolt against k_stretch, time step and iterations, on the limb
# and on bodies. k_stretch strongly changes Frankie's frequency and hardly that of the others. Time step and iterations,
# which are not material parameters, change all frequencies. Damping is not a parameter at all; the finite elements
# shown for comparison swing almost undamped.

jolt_columns = {"deformer", "k_stretch", "time_step_ms", "iterations", "masses", "k_bind", "outcome", "frequency_hz",
                "frequency_low_hz", "frequency_high_hz", "damping_ratio", "damping_low", "damping_high", "young_pa"}
usual_jolt = {"k_stretch": 0.1, "time_step_ms": 10.0, "iterations": 24.0}
names = {"k_stretch": "k_stretch [1]", "time_step_ms": "time step [ms]", "iterations": "iterations"}
measures = [("frequency_hz", ("frequency_low_hz", "frequency_high_hz"), "frequency [Hz]"),
            ("damping_ratio", ("damping_low", "damping_high"), "damping ratio [1]")]
jolted = ("limb", "human", "man", "lady", "frankie")


def only_varied(rows, factor, usual):
    """The rows in which the other factors have their usual value."""
    return [row for row in rows if all(float(row[name]) == value for name, value in usual.items() if name != factor)]


def draw_jolted(axes, rows, body, number):
    """The default masses and bind constraint, where the swing was found."""
    rows = [row for row in rows if (row["outcome"], row["deformer"], row["masses"]) == ("found", "pbs", "unit")]
    behind = []
    for panels, factor in zip(axes.T, names):
        shown = sorted(only_varied(rows, factor, usual_jolt | {"k_bind": 1.0}), key=lambda row: float(row[factor]))
        for panel, (measure, ends, _) in zip(panels, measures if shown else []):
            style.draw_series(panel, number, shown, factor, measure, ends, label=body)
        behind += style.taken(shown, sorted(jolt_columns), body=body, varied=factor)
    return behind


def draw_reference(axes, rows):
    """Damping of the limb with finite elements in time, and of PBS on the same mesh with the default iterations. The
    modulus of the elements was chosen so that they swing at the same frequency, so their frequency carries no
    information."""
    found = [row for row in rows if row["outcome"] == "found" and float(row["k_bind"]) == 1.0
             and float(row["iterations"]) == usual_jolt["iterations"]]
    for row in found:
        name = looks.of(row["deformer"]).name
        label = f"{name}, on the FEM's mesh" if row["deformer"] == "pbs" else f"{name}, in time, limb"
        axes.plot(float(row["k_stretch"]), float(row["damping_ratio"]), **style.as_of(
            row["deformer"], label=label, linestyle="none", markersize=8, markerfacecolor="none", markeredgewidth=0.8))
    last = {row["deformer"] == "pbs": (float(row["k_stretch"]), float(row["damping_ratio"])) for row in found}
    for is_pbs, place in last.items():
        axes.annotate("PBS on the FEM's mesh" if is_pbs else "FEM in time, limb", place, (7, -7 if is_pbs else 7),
                      va="center", textcoords="offset points", fontsize=style.tick_size)
    return style.taken(found, sorted(jolt_columns), body="limb_reference", varied="")


def jiggle_response_facts(rows):
    """The ratio by which each factor changes the frequency over the values shown, over the bodies; the settings that
    are held fixed; and the elements' moduli."""
    def folds(factor):
        hz = [[float(row["frequency_hz"]) for row in rows if (row["body"], row["varied"]) == (body, factor)]
              for body in jolted]
        return span([max(found) / min(found) for found in hz if len(found) > 1])

    young_kpa = [float(row["young_pa"]) / 1000 for row in rows if row["body"] == "limb_reference"
                 and row["deformer"] != "pbs"]
    k_stretch, step_ms, iterations = (figure(value) for value in usual_jolt.values())
    held = f"k_stretch {k_stretch}, {step_ms} ms and {iterations} iterations"
    return {factor: folds(factor) for factor in names if factor != "k_stretch"} | {"held": held,
                                                                                   "young_kpa": span(young_kpa)}


def jiggle_response(results):
    folder = results / "jiggle"
    found = {body: folder / f"{body}_jolt" / "responses.csv" for body in jolted}
    found = {body: records.table(file, jolt_columns) for body, file in found.items() if file.is_file()}
    drawing, axes = style.panels(2, 3, height_in=1.9, sharex="col", sharey="row")
    behind = [row for number, (body, rows) in enumerate(found.items()) for row in draw_jolted(axes, rows, body, number)]
    behind += draw_reference(axes[1][0], records.table(folder / "limb_reference" / "responses.csv", jolt_columns))
    style.label(axes, (), [name for *_, name in measures], names.values())
    style.log_scale(axes[1][1].xaxis, [2.5, 10, 40])
    style.log_scale(axes[1][2].xaxis, [6, 24, 96])
    style.log_scale(axes[0][0].yaxis)
    axes[1][0].set_ylim(bottom=-0.02)
    axes[1][0].set_xticks([0, 0.5, 1.0])
    style.key_below(drawing)
    return drawing, behind


# Force over displacement of flesh under its weight against iterations, time step and resolution. The stiffness of a
# material would be a flat line. The stiffness of PBS grows with the iterations and falls with the square of the time
# step. Mueller's exponent removes neither dependence. XPBD, which keeps multipliers, is nearly flat. Values too stiff
# to move in double precision are left out.

bodies = [("bar", "cantilever", "bar, held at one end"), ("limb", "zone", "limb's jiggling zone"),
          ("human", "zone", "human's jiggling zone")]
factors = {"iterations": "iterations", "time_step_ms": "time step [ms]", "vertices": "vertices"}
usual = {"iterations": 24.0, "time_step_ms": 10.0}
young_pa = 30e3  # of XPBD; some sweeps also use stiffer values
of_claim = "stiffness_ratio_at_twice_iterations"
# Beyond this, 1 N moves the flesh by less than double precision resolves at 1 m.
stiffest_n_m = 1 / sys.float_info.epsilon
# method, k_stretch, its look, words after its name, and whether it is drawn hollow
methods = [("pbs", 0.2, "pbs", ", k_stretch 0.2", False), ("pbs", 0.9, "pbs", ", k_stretch 0.9", True),
           ("exponent", 0.2, "pbs_exponent", "", False), ("xpbd", 0.2, "xpbd", ", 30 kPa", False),
           ("xpbd_small_steps", 0.2, "xpbd_small_steps", ", 30 kPa", True)]
columns = {"body", "load", "vertices", "mesh", "method", "k_stretch", "young_pa", "iterations", "time_step_ms",
           "order_seed", "by", "stiffness_n_m", "converged"}


def varied(rows, factor, method, k_stretch):
    """Rows by the linear response, in the first order of constraints. A row that did not converge or is not positive
    has no stiffness."""
    rows = [row for row in rows if (row["method"], row["by"], row["order_seed"],
                                    row["converged"]) == (method, "linear", "0", "1")
            and float(row["stiffness_n_m"]) > 0]
    rows = only_varied(rows, factor, usual | {"k_stretch": k_stretch, "young_pa": young_pa})
    return sorted({float(row[factor]): row for row in rows}.values(), key=lambda row: float(row[factor]))


def draw_panel(axes, rows, factor):
    behind, left_out = [], 0
    for method, k_stretch, deformer, setting, hollow in methods:
        found = varied(rows, factor, method, k_stretch)
        shown = [row for row in found if float(row["stiffness_n_m"]) <= stiffest_n_m]
        left_out += len(found) - len(shown)
        if shown:
            look = looks.of(deformer)
            drawn = {"linestyle": looks.lines["dotted"],
                     "markerfacecolor": "none"} if hollow else {"markerfacecolor": look.color}
            style.plot(axes, shown, factor, "stiffness_n_m",
                       **style.as_of(deformer, label=look.name + setting, **drawn))
        behind += style.taken(shown, sorted(columns), varied=factor)
    values = sorted({float(row[factor]) for row in behind})
    axes.set_yscale("log")
    if left_out:
        axes.annotate(f"{left_out} stiffer, not shown", (0.03, 0.9), xycoords="axes fraction", fontsize=style.tick_size)
    if values and factor != "vertices":
        style.log_scale(axes.xaxis, values[::max(1, len(values) // 2)])
    elif values:  # mesh sizes come in pairs that are nearly equal, whose labels would overlap
        style.log_scale(axes.xaxis, [values[0], values[-1]])
    return behind


def stiffness_facts(rows):
    """The ratio by which XPBD stiffens over the iterations shown, plain and in small steps, over the bodies; and the
    other settings."""
    def folds(method):
        shown = [[float(row["stiffness_n_m"]) for row in rows
                  if (row["body"], row["varied"], row["method"]) == (body, "iterations", method)]
                 for body, _, _ in bodies]
        return span([found[-1] / found[0] for found in shown if len(found) > 1])

    held = {"iterations": figure(usual["iterations"]), "step_ms": figure(usual["time_step_ms"])}
    doubled = span([float(row["value"]) for row in rows if row["varied"] == "doubled iterations"])
    return {"xpbd": folds("xpbd"), "small_steps": folds("xpbd_small_steps"), "doubled": doubled} | held


def stiffness(results):
    drawing, axes = style.panels(3, 3, height_in=1.6)
    behind = []
    for panels, (body, load, _) in zip(axes, bodies):
        for panel, factor in zip(panels, factors):
            sweep = {"time_step_ms": "time_step", "vertices": "resolution"}.get(factor, factor)
            rows = records.table(results / "stiffness" / f"{sweep}_{body}" / "stiffness.csv", columns)
            behind += draw_panel(panel, [row for row in rows if row["load"] == load], factor)
    for file in sorted(results.glob("stiffness/iterations_*/measurements.csv")):  # the values of C11
        rows = records.table(file, {"quantity", "body", "deformer", "load", "k_stretch", "value"})
        behind += style.taken([row for row in rows if (row["quantity"], row["deformer"],
                                                       row["load"]) == (of_claim, "pbs", "zone")],
                              ("body", "load", "k_stretch", "value"), varied="doubled iterations")
    style.label(axes, (), [f"{title}\nstiffness [N/m]" for *_, title in bodies], factors.values())
    style.key_below(drawing)
    return drawing, behind
