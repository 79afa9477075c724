"""Error against run time: who is nearest within which time, the poses that are solved, what was tried and what is missing, and what single
changes to PBS gain. Fronts are on the page where their table is there; it is too long to be kept."""
import pages
import records
from words import case_words, looks

comparisons, clocks = (case_words.tables[field] for field in ("comparison", "clock"))
setting = ("iterations", "k_stretch", "order", "precision", "substeps", "element_order", "wanted_vertices", "tuned")
budgets = (1.0, 10.0, 100.0, float("inf"))


def words_of(row, deformer="deformer"):
    """pbs, iterations 24, k_stretch 0.2, order ordered, precision f32, packed"""
    named = [f"{column} {row[column]}" for column in setting if row[column] and (column, row[column]) != ("substeps", "1")]
    return ", ".join([row[deformer], *named, *(name for name in ("packed", "refined") if row[name] == "1")])


def of_comparison(rows, comparison):
    return [row for row in rows if row["comparison"] == comparison]


def split(folder, points):
    training, evaluation = (", ".join(run for run, rows in points.items() if rows[0]["half"] == half) or "none"
                            for half in ("training", "evaluation"))
    text = (f"Settings are chosen on the training poses ({training}) and shown on the evaluated poses ({evaluation}). The poses of "
            "each body alternate, and a body with one pose is only evaluated.\n")
    own = {row["deformer"]: clocks.get(row["clock"], "it has no time") for rows in points.values() for row in rows
           if row.get("external") == "1"}
    return text + ("\nDeformers of the user's own take part in both comparisons, since it is not known whether their code is packed. Their "
                   "times were taken as follows:\n\n" + "".join(f"- `{name}`: {clock}\n" for name, clock in own.items()) if own else "")


def nearest(folder):
    """The nearest class within each time with its nearest deformer, and the others that are not decided against."""
    rows = records.read_rows(folder / "nearest.csv")
    text = ""
    for comparison, words in comparisons.items():
        shown = []
        for row in of_comparison(rows, comparison):
            if row["among"] == "classes":
                shown.append(row | {"within_class": ""})
            else:
                shown[-1]["within_class"] = row["either_of"]
        text += f"\n## Nearest within a time: {words}\n\n" + pages.table(
            shown, "nearest", words_of=words_of,
            classes=lambda row: " or ".join(name.replace("_", " ") for name in [row["nearest"], *row["either_of"].split()]),
            within_class=lambda row: ", ".join(looks.of(name).name for name in row["within_class"].split()))
    return text


def profiles(folder):
    """The poses that each group solves to a tolerance within a time, and those that are certain. There may be no evaluated pose."""
    rows = records.read_rows(folder / "data_profiles.csv")
    text = ""
    for comparison, words in comparisons.items():
        of = of_comparison(rows, comparison)
        tolerances = sorted({float(row["tolerance_pct"]) for row in of}, reverse=True)

        def solved(group, tolerance, ms):
            steps = [row for row in of if row["group"] == group and float(row["tolerance_pct"]) == tolerance and float(row["ms"]) <= ms]
            return f"{steps[-1]['solved']}, {steps[-1]['certain']} certain" if steps else "0"

        columns = {"group": lambda row: looks.of(row["group"]).name}
        for tolerance in tolerances:
            for ms in budgets:
                heading = f"{tolerance:g} %" + (f", {ms:g} ms" if ms < budgets[-1] else "")
                columns[heading] = lambda row, tolerance=tolerance, ms=ms: solved(row["group"], tolerance, ms)
        poses = of[0]["poses"] if of else "0"
        text += (f"\n## Poses solved, of {poses}: {words}\n\nA pose is solved with certainty if the error plus the bound on the "
                 "reference's own error is within the tolerance. Groups that solve no pose are not listed.\n\n"
                 + pages.table([{"group": group} for group in looks.in_order({row["group"] for row in of})], columns))
    return text


def tried(folder):
    counts = {}
    for row in records.table(folder / "settings.csv", {"comparison", "deformer", "tried"}):
        shown, settings = counts.get((row["comparison"], row["deformer"]), (0, 0))
        counts[row["comparison"], row["deformer"]] = shown + 1, settings + int(row["tried"])
    rows = [{"comparison": comparison, "deformer": deformer, "shown": str(shown), "tried": str(settings)}
            for (comparison, deformer), (shown, settings) in counts.items()]
    return ("\n## Settings tried\n\nA setting is a number of iterations (or an element order) on a mesh with one value of the grid. One "
            "value for each of these numbers is shown.\n\n" + pages.table(rows, "settings"))


def omissions(folder):
    rows = records.read_rows(folder / "omissions.csv")
    return "\n## Omissions\n\n" + pages.table(rows, "omissions") if rows else ""


def references(points):
    rows = [row | {"case": run, "s": float(row["reach_ms"]) / 1e3} for run, of in points.items() for row in of
            if row["outcome"] in ("reference", "not_reached")]
    return "\n## References\n\n" + pages.table(rows, "references", words_of=words_of)


def fronts(folder):
    rows = [row for row in records.table(folder / "fronts.csv", {"comparison", "case", "front"}) if row["front"] == "all"]
    return "\n## The front of all points\n\n" + pages.table(rows, "fronts", words_of=words_of)


def remark(gain):
    if gain["decision"] == "reference_error":
        shift = gain["reference_error_pct"]
        return f"the reference's own error {f'may change it by {float(shift):.2g} points' if shift else 'is not known'}"
    return {"few_poses": "fewer than 4 poses", "poses_disagree": "the interval over the poses includes zero"}.get(gain["decision"], "")


def gains(folder):
    """One table per group of poses and budget, the largest gain first, and the changes that are not ranked."""
    rows = records.read_rows(folder / "gains.csv")
    changes = sorted({row["change"] for row in rows})
    text = "\n# What single changes to PBS gain in equal time\n" if rows else ""
    for group, budget in dict.fromkeys((row["group"], row["budget_iterations"]) for row in rows):
        own = [row for row in rows if (row["group"], row["budget_iterations"]) == (group, budget)]
        poses = "all poses" if group == "all" else f"the poses of the body {group}"
        text += f"\n## In the time of {budget} iterations of PBS, {poses}\n\n" + pages.table(
            own, "gains", change=lambda row: row["change"].replace("_", " "), than=lambda row: row["than"].replace("_", " "), remark=remark)
        over_pbs = {row["change"]: int(row["poses"]) for row in own if row["than"] == "pbs"}
        most = max(over_pbs.values())
        omitted = [f"{change.replace('_', ' ')} ({over_pbs.get(change, 0)} of {most} poses)" for change in changes
                   if over_pbs.get(change, 0) < most]
        if omitted:
            text += f"\nNot ranked, because no setting fits into the budget in every pose: {', '.join(omitted)}.\n"
    return text


def page(folder):
    runs = [run["name"] for run in records.read_json(folder / "plan.json")["runs"]]
    points = {run: records.table(folder / run / "points.csv", {"deformer", "half", "outcome"}) for run in runs
              if (folder / run / "points.csv").is_file()}
    return ("# Error against run time\n\n" + split(folder, points) + nearest(folder) + profiles(folder) + references(points) + tried(folder)
            + omissions(folder) + fronts(folder) + gains(folder))
