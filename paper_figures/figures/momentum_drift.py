"""The change of linear and angular momentum by one projection of a class of constraints, relative to the momentum exchanged. With weighted
masses only rounding remains, in both precisions. The formulae for unit masses (Eq. 8-9) on unequal masses lose up to a third. The bind
constraint transfers all of it to the bones, whose motion is prescribed."""
import records
from drawing import style
from records import entries

quantities = {"linear_drift": "linear momentum", "angular_drift": "angular momentum", "linear_drift_taken_by_bones": "linear momentum",
              "angular_drift_taken_by_bones": "angular momentum"}
masses = {"equal": "equal masses", "unequal": "unequal masses, weighted", "unequal_by_eq_8_9": "unequal masses, Eq. 8\u20139"}
bodies = ("limb", "human")
looks = {("limb", "f32"): (style.vermillion, "v", "limb, f32"), ("limb", "f64"): (style.vermillion, "^", "limb, f64"),
         ("human", "f32"): (style.blue, "o", "human, f32"), ("human", "f64"): (style.blue, "s", "human, f64")}


def rows_of(file, body):
    """One row per class of constraints, masses and precision, from single projections."""
    found = [{"momentum": quantities[row["quantity"]], "masses": row["masses"], "body": body, "constraints": row["constraint"],
              "precision": row["precision"], "drift": row["value"]}
             for row in records.table(file, {"quantity", "body", "masses", "constraint", "precision", "value"})
             if row["quantity"] in quantities and row["body"] == body]
    if not found:
        raise records.RecordsMissing(f"{file}: no drift of {body}")
    return found


def draw_momentum(axes, rows, places):
    for (body, precision), (color, marker, label) in looks.items():
        shown = [row for row in rows if (row["body"], row["precision"]) == (body, precision)]
        aside = 0.15 if precision == "f64" else -0.15
        drift, place = [float(row["drift"]) for row in shown], [places[row["constraints"], row["masses"]] + aside for row in shown]
        axes.plot(drift, place, linestyle="none", marker=marker, color=color, label=label, markersize=4.5,
                  markerfacecolor=color if precision == "f32" else "white")
    axes.set_xscale("log")
    axes.set_yticks(list(places.values()), [f"{constraints}, {masses[of]}" for constraints, of in places])
    axes.set_ylim(len(places) - 0.5, -0.5)
    axes.set_xlabel("change over the momentum exchanged [1]")


def momentum_drift(results, figures):
    folder = results / "momentum"
    rows = [row for body in bodies for row in rows_of(folder / body / "measurements.csv", body)]
    by_class = sorted(rows, key=lambda row: row["constraints"], reverse=True)
    places = {key: place for place, key in enumerate(dict.fromkeys((row["constraints"], row["masses"]) for row in by_class))}
    figure, axes = style.panels(1, 2, height_in=2.4, sharey=True)
    for panel, momentum in zip(axes[0], ("linear momentum", "angular momentum")):
        draw_momentum(panel, [row for row in rows if row["momentum"] == momentum], places)
        panel.set_title(momentum)
    style.legend_above(figure, columns=4)
    style.save(figure, figures / "momentum_drift", entries.origin_of(results, "momentum_drift"), rows)
