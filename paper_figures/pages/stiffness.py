"""The ratio of stiffnesses for one doubling, the exponents over all settings, and where XPBD changes by more than a
tenth."""
import pages
import records
from words import case_words

doubled = {"iterations": "twice the iterations", "time_step": "half the time step", "resolution": "twice the vertices"}
factors = {"iterations": "iterations", "time_step": "1 / time step", "resolution": "vertices"}
unchanged = (0.9, 1.1)


def words_of(row):
    """bar, PBS, loaded as a cantilever, 1016 vertices, k_stretch 0.05, 12 to 48 iterations"""
    numbers = ("vertices", "vertices_to", "k_stretch", "young_pa", "iterations", "iterations_to", "time_step_s",
               "time_step_to_s")
    return case_words.of({name: row[name] for name in ("body", "deformer", "load", "ladder") if row.get(name)}
                         | {name: float(row[name]) for name in numbers if row.get(name)})


def is_claimed(row):
    """Whether C11 is about this row: PBS under the weight of its jiggling zone alone."""
    return row["deformer"] == "pbs" and row["load"] == "zone"


def leaves(row):
    return row["deformer"] in ("xpbd", "xpbd_small_steps") and not unchanged[0] <= float(row["low"]) <= float(
        row["high"]) <= unchanged[1]


def page(folder):
    measured = pages.of_runs(folder, "measurements.csv", {"quantity", "deformer", "load", "value", "low", "high"})
    measured.sort(key=lambda row: not is_claimed(row))
    exponents = records.table(folder / "exponents.csv",
                              {"varied", "first", "last", "exponent", "exponent_low", "exponent_high", "left_out"})
    text = ("# Effective stiffness\n\nWeight of the jiggling zone, or of a bar's free length, over its mean "
            "displacement. C11 is about PBS with the load `zone`, whose rows come first; with `zone on held`, "
            "the body outside the zone is held.\n")
    columns = {"case": words_of, "ratio": "value:g4", "least": "low:g4", "largest": "high:g4"}
    for varied, words in doubled.items():
        quantity = "stiffness_ratio_at_" + words.replace("the ", "").replace("vertices", "resolution").replace(" ", "_")
        text += f"\n## Ratio at {words}\n\n" + pages.table([row for row in measured if row["quantity"] == quantity],
                                                           columns)
        rows = [row for row in exponents if row["varied"] == varied]
        text += f"\n## Stiffness ~ ({factors[varied]})^p\n\n" + pages.table(rows, "exponents", case=words_of)
    outside = [row for row in measured if leaves(row)]
    return text + f"\n## Where XPBD, which is meant not to change, leaves {unchanged[0]:g} to {unchanged[1]:g}\n\n" + (
        pages.table(outside, {"quantity": "quantity"} | columns) if outside else "Nowhere.\n")
