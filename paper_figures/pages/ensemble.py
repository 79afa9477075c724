"""The parts of PBS's error, and its distance from flesh that bones hold in other ways."""
import pages
from words import case_words
from words.number_words import counted, span

paper_s = "0.2"  # k_stretch of the scenes


def pose(row):
    return row["pose"] or f"{float(row['angle_deg']):g}\u00b0"


def answer(parts):
    """The ranges over the poses, at the scenes' k_stretch."""
    rows = [row for row in parts if row["k_stretch"] == paper_s]
    solver, model, bound = (span([row.number(f"{part}_pct") for row in rows])
                            for part in ("solver", "model", "discretisation"))
    return (f"After 24 iterations in {counted(len(rows), 'pose')}, the solver is {solver} % of the mean bone distance "
            f"away from the converged constraints. These are {model} % away from flesh, which is known within "
            f"{bound} %.\n")


def attachments(folder):
    rows = [row for row in pages.of_runs(folder, "attachments.csv",
                                         {"attachment", "difference_pct", "model_pct", "k_stretch"})
            if row["k_stretch"] == paper_s]
    return ("\n## Flesh that is held in other ways [% of the bone distance]\n\nThe first row of a pose is the "
            "reference. The distance from it includes the discretisation error of the flesh in its row, "
            "which is solved on the body's own tets alone.\n\n"
            + pages.table(rows, "attachments", pose=pose, held=held))


def held(row):
    """The law, the attachment, and the springs' q and the bones' radius where it has them."""
    numbers = [f"{letter} {float(row[column]):g}" for letter, column in (("q", "spring_factor"),
                                                                         ("radius", "core_radius")) if row[column]]
    return ", ".join([case_words.of_field("law", row["model"]), case_words.in_plain(row["attachment"]), *numbers])


def page(folder):
    parts = [row for row in pages.of_runs(folder, "parts.csv", {"iterations", "k_stretch", "solver_pct"})
             if row["iterations"] == "24"]
    return ("# The parts of PBS's error\n\n" + answer(parts) + "\n## After 24 iterations [% of the bone distance]\n\n"
            + pages.table(parts, "parts", pose=pose) + attachments(folder))
