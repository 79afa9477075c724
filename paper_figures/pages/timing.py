"""The cost of a frame on each mesh and the size at which real time ends, what each switch of a scene costs, and the times to equal answers.
The table of the bench is a text of its own, bench.txt."""
import pages
import records

frame = pages.own_names(
    "body vertices variant precision lbs_ms:3 bind_ms:3 stretch_ms:3 volume_ms:3 total_wall_ms:g frames_per_s:0 drawn_frames_per_s:0 "
    "paper_frames_per_s:1 total_wall_ms_low:g total_wall_ms_high:g total_ms:g rest_ms:g surface_ms:g paper_ms:2 paper_ct_ms:2 model "
    "vertices_over_table_1:2 edges_over_table_1:2 tets_over_table_1:2")
switch = pages.own_names(
    "scene feature frame_cpu_ms_without:2 frame_cpu_ms_with:2 frame_cpu_ms_ratio:2 frame_cpu_ms_ratio_lower:2 frame_cpu_ms_ratio_upper:2 "
    "frame_ms_without:2 frame_ms_with:2 step_cpu_ms_without:2 step_cpu_ms_with:2 start_s_without:2 start_s_with:2 peak_mb_without:0 "
    "peak_mb_with:0 shared_objects_without shared_objects_with largest_distance_m:g2 volume_difference_pct:g2")
order = pages.own_names("body angle_deg:0 pose order precision")
limits = pages.own_names("iteration_ms:4 residual_24:g4 volume_abs_change_24_pct:3 residual_limit:g4 volume_abs_change_limit_pct:3")
times = pages.own_names("target bound:g4 iterations ms:2 limit:g4 speedup_to_plain:2 speedup_to_plain_spread:2")


def of_table(folder, name, title, columns):
    """A section; nothing where the table was not written."""
    rows = records.read_rows(folder / name) if (folder / name).is_file() else []
    return f"\n{title}\n\n" + pages.table(rows, columns) if rows else ""


def orders(folder):
    """Each order in file order: its answer, and the time to an equal one."""
    rows = [row for row in pages.of_runs(folder, "orders.csv", {"order", "sequence"}) if row["sequence"] == "file"]
    if not rows:
        return ""
    return ("\n## Times to equal answers\n\nThe first table has each order after 24 iterations and in the limit, in file order. Every time "
            "of plain is that of the order `plain`, which is built for the same bits on every machine.\n\n"
            + pages.table(rows, order | limits)
            + of_table(folder, "answers.csv", "The second table has the time to an equal answer. An empty cell states that the target is "
                       "never reached, so that no speed-up exists.", order | times))


def frames(folder):
    if not (folder / "timing.csv").is_file():  # a part of the study may be run alone
        return ""
    rows = records.table(folder / "timing.csv", {"variant", "total_wall_ms", "cpu_model"})
    machines = "; ".join(sorted({row["cpu_model"] for row in rows}))
    return (f"\nTimed on {machines}. Times are per frame.\n\n" + pages.table(rows, frame)
            + of_table(folder, "real_time.csv", "On the line through the ladder of sizes, 30 frames per second are reached up to this "
                       "number of vertices, and the time per frame is proportional to vertices^exponent:",
                       pages.own_names("variant precision vertices:g") | {
                           "beyond the measured sizes": lambda row: "yes" if row["is_beyond"] == "1" else "", "exponent": ("exponent", 2)}))


def page(folder):
    return ("# The cost of a frame\n" + frames(folder) + of_table(folder, "features.csv", "## Switches of a scene", switch)
            + orders(folder))
