"""The growth of the cost of a step of 24 iterations with the mesh, in ns per constraint and iteration with one thread, and the speedup by
more threads."""
import records
from drawing import bench_records, style
from records import entries


def by_size(record):
    return sorted(record["meshes"], key=lambda mesh: mesh["mesh"]["tets"])


def timing_of(mesh, variant, precision, threads):
    for timing in bench_records.timings(mesh):
        if (timing["variant"], timing["precision"], timing["threads"]) == (variant, precision, threads):
            return timing
    return None


def write_exponents(axes, record, precision):
    """Writes the fitted exponents of cost over constraints into the corner of the panel, and returns them."""
    fits = {fit["variant"]: fit for fit in record.get("scaling", []) if (fit["precision"], fit["threads"]) == (precision, 1)}
    lines = ["step \u221d constraints$^e$, 95 %"] if fits else []
    rows = []
    for variant in ("plain", "ordered", "grouped", "poses"):
        if variant in fits:
            low, high = fits[variant]["interval"]
            lines.append(f"{variant}: e = {fits[variant]['exponent']:.2f}" + (f" [{low:.2f}, {high:.2f}]" if low is not None else ""))
            rows.append({"shown": "exponent", "order": variant, "precision": precision, "threads": 1, "value": fits[variant]["exponent"],
                         "low": low, "high": high})
    axes.annotate("\n".join(lines), (0.03, 0.03), xycoords="axes fraction", fontsize=6, va="bottom")
    return rows


def draw_cost(axes, record, precision):
    rows = []
    for variant, (color, line) in bench_records.orders.items():
        found = [(mesh, timing_of(mesh, variant, precision, 1)) for mesh in by_size(record)]
        found = [(mesh, timing) for mesh, timing in found if timing]
        iterations = record["context"]["iterations"]
        scale = [1e6 / iterations / bench_records.constraints(mesh) for mesh, _ in found]
        median = [timing["ms_step"] * s for (_, timing), s in zip(found, scale)]
        tets = [mesh["mesh"]["tets"] for mesh, _ in found]
        axes.plot(tets, median, color=color, linestyle=line, marker=bench_records.markers[variant], label=bench_records.names[variant])
        quartiles = [[timing["quartiles"]["ms_step"][bound] * s for (_, timing), s in zip(found, scale)] for bound in (0, 1)]
        axes.fill_between(tets, *quartiles, color=color, alpha=0.2, linewidth=0)
        rows += [{"shown": "ns_per_constraint", "order": variant, "precision": precision, "threads": 1, "tets": t, "value": m,
                  "low": low, "high": high} for t, m, low, high in zip(tets, median, *quartiles)]
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("tets")
    axes.set_ylabel("ns per constraint and iteration")
    axes.set_ylim(bottom=axes.get_ylim()[0] / 7)
    axes.set_title(f"{precision}, one thread")
    return rows + write_exponents(axes, record, precision)


def draw_threads(axes, record):
    rows = []
    threads = record["context"]["threads"]
    for variant in ("ordered", "grouped", "poses"):
        for precision, line in (("f32", "-"), ("f64", (0, (4, 1.5)))):
            found = [(mesh["mesh"]["tets"], timing_of(mesh, variant, precision, threads)) for mesh in by_size(record)]
            found = [(tets, timing["speedup_by_threads"]) for tets, timing in found if timing and "speedup_by_threads" in timing]
            if not found:
                continue
            axes.plot(*zip(*found), color=bench_records.orders[variant][0], linestyle=line, marker=bench_records.markers[variant],
                      label=bench_records.names[variant])
            rows += [{"shown": "speedup_by_threads", "order": variant, "precision": precision, "threads": threads, "tets": t, "value": s}
                     for t, s in found]
    axes.axhline(1, color="#808080", linewidth=0.6)
    axes.set_xscale("log")
    axes.set_xlabel("tets")
    axes.set_ylabel("speedup over one thread")
    axes.set_title(f"{threads} threads: f32 solid, f64 dashed")
    return rows


def scaling(results, figures):
    record = bench_records.read(results)
    figure, axes = style.panels(1, 3, height_in=2.6)
    behind = draw_cost(axes[0][0], record, "f32") + draw_cost(axes[0][1], record, "f64") + draw_threads(axes[0][2], record)
    if not behind:
        raise records.RecordsMissing(f"{results / 'bench' / 'bench.json'}: no timings")
    style.legend_above(figure, columns=6)
    style.save(figure, figures / "scaling", entries.origin_of(results, "scaling"), style.aligned(behind))
