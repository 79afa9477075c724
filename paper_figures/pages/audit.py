"""What the paper prints, against what follows from its other numbers and equations."""
import math

import pages
from words import case_words


def of(row):
    return case_words.of({field: row[field] for field in ("model", "equation", "gradient_of", "reading") if row[field]})


def bound(row):
    least, most = float(row["least"]), float(row["most"] or math.inf)
    return f"{least:.6g}" + (" or more" if most == math.inf else f" to {most:.6g}" if most != least else "")


def page(folder):
    rows = pages.of_runs(folder, "printed.csv", {"claim", "quantity", "printed", "least", "most"})
    return "# The paper against itself\n\n" + pages.table(rows, {
        "claim": "claim", "quantity": "quantity", "of": of, "printed": lambda row: f"{float(row['printed']):.6g}",
        "follows from the rest": bound,
        "consistent": lambda row: "yes" if float(row["least"]) <= float(row["printed"]) <= float(row["most"] or math.inf) else "no"})
