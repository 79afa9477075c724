"""One row per pose and initial guess, in the default order; of a ladder the LBS guess on each mesh."""
import pages
import records


def page(folder):
    rows = []
    for file in pages.files(folder, "rates.csv"):
        rows += [row for row in records.table(file, {"start", "order", "precision", "own_mesh"})
                 if (row["order"], row["precision"]) == ("ordered", "f32")
                 and (row["start"] == "lbs" if file.parent.name.startswith("ladder") else row["own_mesh"] == "1")]
    return "# Convergence from each initial guess\n\n" + pages.table(rows, {
        "body": "body", "pose": "pose", "vertices": "vertices", "k_stretch": "k_stretch", "initial guess": "start",
        "rate": ("rate_per_iteration", 4), "to residual": "iterations_to_residual", "reached": "residual_reached",
        "to volume": "iterations_to_volume", "volume reached": "volume_reached", "masked [%]": ("masked_share_pct", 1),
        "bound [%]": ("reference_bound_pct", 2), "error 24 [%]": ("error_24_pct", 1), "least at": "least_error_iteration",
        "error at the end [%]": ("last_error_pct", 1)})
