"""The outcome of jiggling PBS on the limb, disturbed and then held still, as two settings change together, cell by cell. The maps show
which settings leave tets inverted, which prevent the body from coming to rest, and whether any lets the motion grow without bound."""
import records
from drawing import outcomes, style
from records import entries
from words import case_words

maps = {"map_time_step_k_stretch.csv": "24 iterations", "map_iterations_twist.csv": "time step 10 ms"}
columns = {"factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision", "outcome", "steps"}


def named(factor, unit):
    words = case_words.of_field("factor", factor)
    return f"{words} [{'degrees' if unit == 'deg' else unit}]" if unit != "1" or factor == "k_stretch" else words


def draw_map(axes, rows, title):
    across = sorted({float(row["value"]) for row in rows})
    up = sorted({float(row["second_value"]) for row in rows})
    places = [(across.index(float(row["value"])), up.index(float(row["second_value"]))) for row in rows]
    for (x, y), row in zip(places, rows):
        axes.fill_between([x - 0.5, x + 0.5], y - 0.5, y + 0.5, color=outcomes.looks[row["outcome"]][0], linewidth=0)
    outcomes.draw_marks(axes, places, [row["outcome"] for row in rows], size=26)
    axes.set_xticks(range(len(across)), [f"{value:g}" for value in across])
    axes.set_yticks(range(len(up)), [f"{value:g}" for value in up])
    axes.set(xlim=(-0.5, len(across) - 0.5), ylim=(-0.5, len(up) - 0.5), title=title)
    axes.set_xlabel(named(rows[0]["factor"], rows[0]["unit"]))
    axes.set_ylabel(named(rows[0]["second_factor"], rows[0]["second_unit"]))
    axes.grid(False)


ends = {"converged": "at rest as if undisturbed", "bounded": "bounded", "inverted": "with inverted tets", "diverged": "diverged",
        "not_finite": "not finite"}


def stability_maps_facts(rows):
    """The number of cells of each map by outcome, and the steps of the longest run."""
    def counts(file):
        found = [row["outcome"] for row in rows if row["map"] == file]
        return f"of {len(found)} cells " + ", ".join(f"{found.count(outcome)} {words}" for outcome, words in ends.items())

    left, right = map(counts, maps)
    return {"left": left, "right": right, "steps": max(int(row["steps"]) for row in rows)}


def stability_maps(results, figures):
    folder = results / "stability"
    figure, axes = style.panels(1, 2, height_in=2.3)
    behind = []
    for panel, (file, title) in zip(axes[0], maps.items()):
        rows = records.table(folder / file, columns)
        draw_map(panel, rows, f"limb, PBS with jiggle, {title}")
        behind += [{"map": file} | {column: row[column] for column in sorted(columns)} for row in rows]
    outcomes.legend(figure, axes[0][0])
    style.save(figure, figures / "stability_maps", entries.origin_of(results, "stability_maps"), behind)
