"""The cost of a frame on each mesh and the size at which real time ends, what each switch of a scene costs, and the
times to equal answers. The table of the bench is a text of its own, bench.txt."""
import pages
import records


def of_table(folder, name, title, columns, **functions):
    """A section; nothing where the table was not written."""
    rows = records.read_rows(folder / name) if (folder / name).is_file() else []
    return f"\n{title}\n\n" + pages.table(rows, columns, **functions) if rows else ""


def orders(folder):
    """Each order in file order: its answer, and the time to an equal one."""
    if not pages.files(folder, "orders.csv"):  # the quick form has none
        return ""
    rows = [row for row in pages.of_runs(folder, "orders.csv", {"order", "sequence"}) if row["sequence"] == "file"]
    return ("\n## Times to equal answers\n\nThe first table has each order after 24 iterations and in the limit, "
            "in file order. Every time of plain is that of the order `plain`, which is built for the same bits on "
            "every machine.\n\n"
            + pages.table(rows, "limits")
            + of_table(folder, "answers.csv", "The second table has the time to an equal answer. An empty cell states "
                                              "that the target is never reached, so that no speed-up exists.", "times"))


def frames(folder):
    if not (folder / "timing.csv").is_file():  # a part of the study may be run alone
        return ""
    rows = records.table(folder / "timing.csv", {"variant", "total_wall_ms", "cpu_model"})
    machines = "; ".join(sorted({row["cpu_model"] for row in rows}))
    return (f"\nTimed on {machines}. Times are per frame.\n\n" + pages.table(rows, "frame")
            + of_table(folder, "real_time.csv", "On the line through the ladder of sizes, 30 frames per second are "
                                                "reached up to this number of vertices, and the time per frame is "
                                                "proportional to vertices^exponent:",
                       "real_time", is_beyond=lambda row: "yes" if row["is_beyond"] == "1" else ""))


def page(folder):
    return ("# The cost of a frame\n" + frames(folder) + of_table(folder, "features.csv", "## Switches of a scene",
                                                                  "switch")
            + orders(folder))
