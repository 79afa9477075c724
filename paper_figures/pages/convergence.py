"""One row per pose and initial guess, in the default order; of a ladder the LBS guess on each mesh."""
import pages
import records


def is_shown(run, row):
    default = row["order"] == "ordered" and row["precision"] == "f32"
    return default and (row["start"] == "lbs" if run.startswith("ladder") else row["own_mesh"] == "1")


def page(folder):
    rows = []
    for run in (run["name"] for run in records.read_json(folder / "plan.json")["runs"]):
        if (folder / run / "rates.csv").is_file():
            rows += [row for row in records.table(folder / run / "rates.csv", {"start", "order", "precision", "own_mesh"})
                     if is_shown(run, row)]
    return "# Convergence from each initial guess\n\n" + pages.table(rows, {
        "body": "body", "pose": "pose", "vertices": "vertices", "k_stretch": "k_stretch", "initial guess": "start",
        "rate": ("rate_per_iteration", 4), "to residual": "iterations_to_residual", "reached": "residual_reached",
        "to volume": "iterations_to_volume", "volume reached": "volume_reached", "masked [%]": ("masked_share_pct", 1),
        "bound [%]": ("reference_bound_pct", 2), "error 24 [%]": ("error_24_pct", 1), "least at": "least_error_iteration",
        "error at the end [%]": ("last_error_pct", 1)})
