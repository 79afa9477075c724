"""The response of flesh to a jolt: frequency and damping ratio of the first swing against k_stretch, time step and iterations, on the limb
and on bodies. k_stretch strongly changes Frankie's frequency and hardly that of the others. Time step and iterations, which are not
material parameters, change all frequencies. Damping is not a parameter at all; the finite elements shown for comparison swing almost
undamped."""
import records
from drawing import style
from records import entries
from words.number_words import figure, listed, span

columns = {"deformer", "k_stretch", "time_step_ms", "iterations", "masses", "k_bind", "outcome", "frequency_hz", "frequency_low_hz",
           "frequency_high_hz", "damping_ratio", "damping_low", "damping_high", "young_pa"}
usual = {"k_stretch": 0.1, "time_step_ms": 10.0, "iterations": 24.0}
names = {"k_stretch": "k_stretch [1]", "time_step_ms": "time step [ms]", "iterations": "iterations"}
measures = [("frequency_hz", "frequency_low_hz", "frequency_high_hz", "frequency [Hz]"),
            ("damping_ratio", "damping_low", "damping_high", "damping ratio [1]")]
bodies = ("limb", "human", "man", "lady", "frankie")


def varied(rows, factor):
    """The rows in which only this factor differs from the default, and whose swing was found."""
    others = [name for name in usual if name != factor]
    rows = [row for row in rows if row["outcome"] == "found" and (row["deformer"], row["masses"]) == ("pbs", "unit")
            and float(row["k_bind"]) == 1.0 and all(float(row[name]) == usual[name] for name in others)]
    return sorted(rows, key=lambda row: float(row[factor]))


def draw_body(axes, rows, body, number):
    behind = []
    for column, factor in enumerate(names):
        shown = varied(rows, factor)
        if not shown:
            continue
        x = records.numbers(shown, factor)
        for row, (measure, low, high, _) in enumerate(measures):
            bars = records.numbers(shown, low), records.numbers(shown, high)
            style.draw_series(axes[row][column], number, x, records.numbers(shown, measure), body, bars)
        behind += [{"body": body, "varied": factor} | {name: row[name] for name in sorted(columns)} for row in shown]
    return behind


def draw_reference(axes, rows):
    """Damping of the limb with finite elements in time, and of PBS on the same mesh with the default iterations. The modulus of the
    elements was chosen so that they swing at the same frequency, so their frequency carries no information."""
    found = [row for row in rows if row["outcome"] == "found" and float(row["k_bind"]) == 1.0
             and float(row["iterations"]) == usual["iterations"]]
    for row in found:
        fem = row["deformer"] != "pbs"
        axes.plot(float(row["k_stretch"]), float(row["damping_ratio"]), linestyle="none", marker="*" if fem else "o", markersize=8,
                  color=style.black, markerfacecolor=style.yellow if fem else "none", markeredgewidth=0.8,
                  label="neo-Hookean FEM in time, limb" if fem else "PBS on the FEM's mesh")
    return [{"body": "limb_reference", "varied": ""} | {name: row[name] for name in sorted(columns)} for row in found]


def jiggle_response_facts(rows):
    """The ratio by which each factor changes each body's frequency over the values shown, the settings that are held fixed, and the
    elements' moduli."""
    def folds(factor):
        hz = {body: [float(row["frequency_hz"]) for row in rows if (row["body"], row["varied"]) == (body, factor)] for body in bodies}
        return listed([f"{figure(max(found) / min(found))}-fold ({body})" for body, found in hz.items() if len(found) > 1])

    young_kpa = [float(row["young_pa"]) / 1000 for row in rows if row["body"] == "limb_reference" and row["deformer"] != "pbs"]
    k_stretch, step_ms, iterations = (figure(value) for value in usual.values())
    beside = f"{step_ms} ms and {iterations} iterations"
    held = {"held": f"k_stretch {k_stretch}, {beside}", "held_beside": beside}
    return {factor: folds(factor) for factor in names} | held | {"young_kpa": span(young_kpa)}


def jiggle_response(results, figures):
    folder = results / "jiggle"
    found = {body: folder / f"{body}_jolt" / "responses.csv" for body in bodies}
    found = {body: records.table(file, columns) for body, file in found.items() if file.is_file()}
    drawing, axes = style.panels(2, 3, height_in=1.9, sharex="col", sharey="row")
    behind = [row for number, (body, rows) in enumerate(found.items()) for row in draw_body(axes, rows, body, number)]
    behind += draw_reference(axes[1][0], records.table(folder / "limb_reference" / "responses.csv", columns))
    for column, (factor, name) in enumerate(names.items()):
        axes[1][column].set_xlabel(name)
        if factor != "k_stretch":
            ticks = [2.5, 5, 10, 20, 40] if factor == "time_step_ms" else [6, 12, 24, 48, 96]
            style.log_scale(axes[1][column].xaxis, ticks)
    for row, (*_, name) in enumerate(measures):
        axes[row][0].set_ylabel(name)
    style.log_scale(axes[0][0].yaxis)
    axes[1][0].set_ylim(bottom=-0.02)
    axes[1][0].set_xticks([0, 0.2, 0.4, 0.6, 0.8, 1.0])
    style.legend_above(drawing)
    style.save(drawing, figures / "jiggle_response", entries.origin_of(results, "jiggle_response"), behind)
