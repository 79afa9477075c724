"""The figures of the study of run time: the paper's Table 1 with the times measured here, the time of a frame over the
size of the mesh, its growth and the speedup by threads, and the cost of each switch of a scene. `clip_temporal` draws
the study `temporal`."""
import records
from drawing import style
from words import case_words, looks
from words.number_words import figure as figure_of, span

# The paper's Table 1 compared with the times measured here on meshes matched to its counts: a drawn table, its CSV and
# its LaTeX. The paper prints two times that exclude each other, a frame rate and a CT of 100 steps; the table shows
# both as milliseconds per frame. Our milliseconds are processor time, our frame rates wall-clock time.
orders = (("plain", "f64"), ("ordered", "f32"))  # in the order of the mesh file; and the default of this code
# The heads of the lines.
columns = {"model": "model", "mesh": "mesh here", "vertices": "vertices, paper", "edges": "edges, paper",
           "tets": "tets, paper", "paper_frames_per_s": "paper [fps]", "plain_f64_frames_per_s": "plain f64, "
                                                                                                 "wall [fps]",
           "ordered_f32_frames_per_s": "ordered f32, wall [fps]", "paper_ms": "paper, 1/fps [ms]",
           "paper_ct_ms": "paper, CT [ms]", "plain_f64_ms": "plain f64, CPU [ms]",
           "ordered_f32_ms": "ordered f32, CPU [ms]"}


def matched(file):
    """The rows of the meshes that correspond to a row of Table 1: model -> (order, precision) -> row. The paper's own
    body takes precedence over a body that substitutes it."""
    needed = {"mesh", "model", "stands_in", "variant", "precision", "total_ms", "frames_per_s", "paper_ms",
              "paper_ct_ms", "cpu_model"}
    rows = [row for row in records.table(file, needed) if row["model"] not in ("", "-")]
    records.need(rows, f"{file}: no mesh matched to Table 1")
    models = {}
    for row in sorted(rows, key=lambda row: row["stands_in"] != "0"):
        mesh = models.setdefault(row["model"], {"mesh": row["mesh"]})
        if mesh["mesh"] == row["mesh"]:
            mesh[row["variant"], row["precision"]] = row
    return models


def line_of(model, mesh):
    """Counts as printed and as meshed, and times."""
    timed = {f"{order}_{precision}": mesh[order, precision]
             for order, precision in orders if (order, precision) in mesh}
    if len(timed) < len(orders):
        raise records.RecordsMissing(f"timing.csv, {mesh['mesh']}: not timed in "
                                     f"{' and '.join(' '.join(order) for order in orders)}")
    first = timed["plain_f64"]
    found = {"model": model, "mesh": first["body"]}
    for name in ("vertices", "edges", "tets"):
        found[name] = f"{float(first[name]) / float(first[f'{name}_over_table_1']):.0f} / {first[name]}"
    found |= {name: f"{float(first[name]):.{digits}f}" for name, digits in (("paper_ms", 1), ("paper_ct_ms", 2),
                                                                            ("paper_frames_per_s", 1))}
    for name, row in timed.items():
        found |= {f"{name}_ms": f"{float(row['total_ms']):.2f}",
                  f"{name}_frames_per_s": f"{float(row['frames_per_s']):.0f}"}
    return {name: found[name] for name in columns}


def latex(lines, cpu):
    head = " & ".join(columns.values())
    body = "\n".join(" & ".join(line.values()).replace("_", r"\_") + r" \\" for line in lines)
    return (f"% timed on one core of {cpu}; the paper: Intel i5 2.50 GHz, 2014\n"
            f"\\begin{{tabular}}{{ll{'r' * (len(columns) - 2)}}}\n\\toprule\n"
            f"{head} \\\\\n\\midrule\n{body}\n\\bottomrule\n\\end{{tabular}}\n")


def table_1_timing(results):
    models = matched(results / "timing" / "timing.csv")
    lines = [line_of(model, mesh) for model, mesh in models.items()]
    cpu = next(iter(models.values()))["plain", "f64"]["cpu_model"]
    figure, ((axes,),) = style.panels(1, 1, height_in=0.3 + 0.24 * len(columns))
    axes.axis("off")
    cells = [[text.replace(", paper", ",\npaper / here"), *(line[name].replace(" / ", " /\n") for line in lines)]
             for name, text in columns.items()]
    table = axes.table(cells, colWidths=[0.32, *[0.68 / len(lines)] * len(lines)], bbox=(0, 0, 1, 1), cellLoc="right",
                       edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(style.tick_size)
    for (row, column), cell in table.get_celld().items():
        cell.set_linewidth(0.8 if row == 0 else 0.3)
        cell.set_height(1.7 if "\n" in cells[row][0] else 1.0)
        if column == 0:
            cell.set_text_props(ha="left")
        cell.PAD = 0.03
    return figure, lines, {"tex": lambda file, _: file.write_text(latex(lines, cpu))}


def table_1_timing_facts(rows):
    """Frames per second: the least here, and the range in print."""
    least = min(float(row[f"{order}_{precision}_frames_per_s"]) for row in rows for order, precision in orders)
    return {"slowest": f"{least:.0f}", "paper": span([float(row["paper_frames_per_s"]) for row in rows])}


# Wall-clock time per frame on one core over the size of the mesh, for three kernels, and the parts of a frame on the
# meshes that represent the paper's. Crosses mark the paper's frame rates and stars its column CT over 100 steps; the
# two differ by a factor of 20. All times can be compared with 33 ms at the paper's sizes.

kernels = {("plain", "f64"): "plain, f64", ("plain", "f32"): "plain, f32", ("ordered", "f32"): "ordered, f32"}
parts = {"lbs_ms": ("LBS", looks.of("lbs").color, ""), "bind_ms": ("bind", style.olive, "////"),
         "stretch_ms": ("stretch", style.cyan, ""), "volume_ms": ("volume", style.indigo, "...."),
         "rest_ms": ("rest", style.light, "")}
size_columns = {"mesh", "body", "variant", "precision", "vertices", "tets", "total_wall_ms", "total_wall_ms_low",
                "total_wall_ms_high", "paper_ms", "paper_ct_ms", *parts}


def of_kernel(rows, variant, precision):
    return sorted((row for row in rows if (row["variant"], row["precision"]) == (variant, precision)),
                  key=lambda row: int(row["vertices"]))


def draw_sizes(axes, rows):
    for number, (kernel, label) in enumerate(kernels.items()):
        shown = of_kernel(rows, *kernel)
        style.draw_series(axes, number, shown, "vertices", "total_wall_ms", ("total_wall_ms_low", "total_wall_ms_high"),
                          label=label)
    paper = [row for row in shown if row["paper_ms"]]
    for column, marker, label in (("paper_ms", "x", "paper, by frame rate"), ("paper_ct_ms", "*", "paper, by CT")):
        style.plot(axes, paper, "vertices", column, linestyle="none", marker=marker, color=style.ink, markersize=5,
                   label=label)
    axes.axhline(1000 / 30, color=style.ink, linewidth=0.6, label="30 frames/s")
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis)
    axes.set(xlabel="vertices", ylabel="wall-clock time per frame [ms]")


def draw_parts(axes, rows, variant, precision):
    """The parts of a frame, end to end, on the meshes that represent the paper's."""
    shown = [row for row in of_kernel(rows, variant, precision) if row["paper_ms"]]
    left = [0.0] * len(shown)
    for column, (label, color, hatch) in parts.items():
        part_ms = records.numbers(shown, column)
        axes.barh(range(len(shown)), part_ms, left=left, color=color, hatch=hatch, height=0.7, label=label,
                  edgecolor="white", linewidth=0.3)
        left = [low + more for low, more in zip(left, part_ms)]
    axes.set_yticks(range(len(shown)), [f"{row['body']}, {int(row['vertices']):,}" for row in shown])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set(xlabel="processor time [ms]", title=kernels[variant, precision])


def timing_sizes(results):
    rows = [row for row in records.table(results / "timing" / "timing.csv", size_columns)
            if (row["variant"], row["precision"]) in kernels]
    figure, ((sizes,), below) = style.stacked((1, 2.4), (2, 2.6))
    draw_sizes(sizes, rows)
    for panel, kernel in zip(below, (("plain", "f64"), ("ordered", "f32"))):
        draw_parts(panel, rows, *kernel)
    style.key_below(figure)
    return figure, style.taken(rows, sorted(size_columns))


def timing_sizes_facts(rows):
    return {"paper_sizes_ms": span([float(row["total_wall_ms"]) for row in rows if row["paper_ms"]])}


# The growth of the cost of a step of 24 iterations with the mesh, in ns per constraint and iteration with one thread,
# and the speedup by more threads, from the timings of `pbskin bench`.
bench_schema = 2  # `memory` in place of `copy`
# The name, colour, line style and marker of each order.
looks_of_orders = {"plain": ("plain", style.rose, (0, (4, 1.5)), "v"),
                   "plain_native": ("plain, native build", style.sand, (0, (2, 1)), "s"),
                   "plain_spread": ("plain, native, spread", style.ink, (0, (1, 1)), "x"),
                   "ordered": ("ordered", style.indigo, "-", "o"),
                   "poses": ("16 poses, each", style.wine, (0, (4, 1, 1, 1, 1, 1)), "D")}


def read_bench(file):
    record = records.read_json(file)
    if record.get("schema") != bench_schema:
        raise records.RecordsMissing(f"{file}: schema {record.get('schema')}, expected {bench_schema}; repeat "
                                     "`pbskin reproduce timing --full --only bench`")
    for key in ("context", "meshes"):
        if key not in record:
            raise records.RecordsMissing(f"{file}: no {key}")
    return record


def timings_of(record, variant, precision, threads):
    """(mesh, timing of the order or reference operation) of the meshes that have it, by size."""
    by_size = sorted(record["meshes"], key=lambda mesh: mesh["mesh"]["tets"])
    return [(mesh["mesh"], timing) for mesh in by_size for timing in mesh["results"] + mesh.get("yardsticks", [])
            if (timing["variant"], timing["precision"], timing["threads"]) == (variant, precision, threads)]


def write_exponents(axes, record, precision):
    """Writes the fitted exponents of cost over constraints into the corner of the panel, and returns them."""
    fits = {fit["variant"]: fit for fit in record.get("scaling", [])
            if (fit["precision"], fit["threads"]) == (precision, 1)}
    lines = ["step \u221d constraints$^e$, 95 %"] if fits else []
    rows = []
    for variant in ("plain", "ordered", "poses"):
        if variant in fits:
            low, high = fits[variant]["interval"]
            lines.append(f"{variant}: e = {fits[variant]['exponent']:.2f}" + (f" [{low:.2f}, {high:.2f}]"
                                                                              if low is not None else ""))
            rows.append({"shown": "exponent", "order": variant, "precision": precision, "threads": 1,
                         "value": fits[variant]["exponent"], "low": low, "high": high})
    axes.annotate("\n".join(lines), (0.03, 0.03), xycoords="axes fraction", fontsize=style.tick_size, va="bottom")
    return rows


def draw_cost(axes, record, precision):
    rows = []
    for variant, (name, color, line, marker) in looks_of_orders.items():
        found = timings_of(record, variant, precision, 1)
        scale = [1e6 / record["context"]["iterations"] / (mesh["vertices"] + mesh["edges"] + mesh["tets"])
                 for mesh, _ in found]
        tets, median = [mesh["tets"] for mesh, _ in found], [timing["ms_step"] * s
                                                             for (_, timing), s in zip(found, scale)]
        axes.plot(tets, median, color=color, linestyle=line, marker=marker, label=name)
        quartiles = [[timing["quartiles"]["ms_step"][bound] * s for (_, timing), s in zip(found, scale)]
                     for bound in (0, 1)]
        axes.fill_between(tets, *quartiles, color=color, alpha=0.2, linewidth=0)
        rows += [{"shown": "ns_per_constraint", "order": variant, "precision": precision, "threads": 1, "tets": t,
                  "value": m, "low": low, "high": high} for t, m, low, high in zip(tets, median, *quartiles)]
    axes.set(xscale="log", yscale="log", xlabel="tets", ylabel="ns per constraint and iteration",
             title=f"{precision}, one thread")
    axes.set_ylim(bottom=axes.get_ylim()[0] / 7)
    return rows + write_exponents(axes, record, precision)


def draw_threads(axes, record):
    rows = []
    threads = record["context"]["threads"]
    for variant in ("ordered", "poses"):
        name, color, _, marker = looks_of_orders[variant]
        for precision, line in (("f32", "-"), ("f64", (0, (4, 1.5)))):
            found = [(mesh["tets"], timing["speedup_by_threads"])
                     for mesh, timing in timings_of(record, variant, precision, threads)
                     if "speedup_by_threads" in timing]
            if found:
                axes.plot(*zip(*found), color=color, linestyle=line, marker=marker, label=f"{name}, {precision}")
            rows += [{"shown": "speedup_by_threads", "order": variant, "precision": precision, "threads": threads,
                      "tets": t, "value": s}
                     for t, s in found]
    axes.axhline(1, color=style.grey, linewidth=0.6)
    axes.set(xscale="log", xlabel="tets", ylabel="speedup over one thread", title=f"{threads} threads: f32 solid, "
                                                                                  "f64 dashed")
    return rows


def scaling(results):
    file = results / "timing" / "bench" / "bench.json"
    record = read_bench(file)
    figure, axes = style.panels(3, 1, height_in=2.4)
    axes = axes[:, 0]
    behind = draw_cost(axes[0], record, "f32") + draw_cost(axes[1], record, "f64") + draw_threads(axes[2], record)
    records.need(behind, f"{file}: no timings")
    style.key_below(figure)
    return figure, behind


def scaling_facts(rows):
    return {"exponents": span([round(float(row["value"]), 2) for row in rows if row["shown"] == "exponent"])}


# The ratio of the processor time with each switch of a scene to that without it, per frame and per step. Bars show the
# spread over runs.
ratios = [(f"{of}_cpu_ms_ratio", f"time per {of}, with over without [1]") for of in ("frame", "step")]
feature_columns = {"feature", *(ratio + part for ratio, _ in ratios for part in ("", "_lower", "_upper"))}


def features_cost(results):
    found = {scene: records.table(results / "timing" / f"features_{scene}" / "features.csv", feature_columns)
             for scene in ("limb", "human")}
    names = list(dict.fromkeys(row["feature"] for rows in found.values() for row in rows))
    figure, axes = style.panels(1, 2, height_in=1.0 + 0.2 * len(names), sharey=True)
    for panel, (ratio, label) in zip(axes[0], ratios):
        for number, (scene, rows) in enumerate(found.items()):
            shown, (color, marker) = [row for row in rows if row[ratio]], style.sequence[number]
            places = [names.index(row["feature"]) + (number - 0.5) * 0.3 for row in shown]
            panel.hlines(places, *(records.numbers(shown, ratio + end) for end in ("_lower", "_upper")), color=color,
                         linewidth=0.8)
            panel.plot(records.numbers(shown, ratio), places, linestyle="none", color=color, marker=marker,
                       markersize=3.5, label=scene)
        panel.axvline(1, color=style.ink, linewidth=0.6)
        style.log_scale(panel.xaxis)
        panel.set_xlabel(label)
    style.name_rows(axes[0][0], [case_words.of_field("feature", name) for name in names])
    style.key_below(figure)
    return figure, [row for scene, rows in found.items()
                    for row in style.taken(rows, sorted(feature_columns), scene=scene)]


def features_cost_facts(rows):
    """The feature that multiplies the time of a frame most, and by how much."""
    dearest = max(rows, key=lambda row: float(row["frame_cpu_ms_ratio"] or 0))
    return {"dearest": case_words.of_field("feature", dearest["feature"]),
            "ratio": figure_of(float(dearest["frame_cpu_ms_ratio"]))}


# From frame to frame along a clip: the jitter of the skin, and the error against flesh by the initial guess of each
# frame.
summary_columns = {"motion", "deformer", "start", "compared", "error_joint_pct", "worse_than_cold_frames"}


def clip_temporal(results):
    frames = records.table(results / "temporal" / "human_01_01" / "frames.csv",
                           {"deformer", "start", "frame", "jitter_mm"})
    summary = [row for row in records.table(results / "temporal" / "summary.csv", summary_columns)
               if row["motion"] == "01_01"]
    figure, ((jitter,), (starts,)), behind = *style.panels(2, 1, height_in=2.4), []
    for name in ("pbs_author", "delta_mush", "pbs", "quasi_newton", "dqs"):
        own = [row for row in frames if (row["deformer"], row["start"]) == (name, "own") and row["jitter_mm"]]
        style.draw(jitter, name, own, "frame", "jitter_mm", linewidth=0.8)
        behind += style.taken(own, ("deformer", "start", "frame", "jitter_mm"), motion="01_01")
    style.log_scale(jitter.yaxis)
    jitter.set(xlabel="frame, 60 per second", ylabel="jitter of the skin [mm]")
    warm = [row for row in summary if row["start"] == "frame_before"]
    for place, row in enumerate(warm):
        cold = next(of for of in summary if (of["deformer"], of["start"]) == (row["deformer"], "own"))
        for of, start, fill in ((cold, "own initial guess", "white"), (row, "frame before", None)):
            style.draw(starts, row["deformer"], [of | {"place": str(place)}], "error_joint_pct", "place",
                       markerfacecolor=fill, label=f"{looks.short(row['deformer'])}, {start}")
        behind += style.taken([cold, row], sorted(summary_columns))
        starts.annotate(f"worse in {row['worse_than_cold_frames']} of {int(row['compared']) - 1}", (1.02, place),
                        # The first frame has none before it.
                        va="center", xycoords=("axes fraction", "data"), fontsize=style.tick_size)
    style.log_scale(starts.xaxis)
    style.name_rows(starts, [looks.short(row["deformer"]) for row in warm])
    starts.set_xlabel("error at the joints [%]: own guess hollow, frame before filled")
    style.key_below(figure)
    return figure, behind
