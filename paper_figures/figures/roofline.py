"""The performance of each kernel relative to the machine, with one thread: useful operations per second over operations per byte, below the
peak of multiply-adds and the bandwidth of each level of memory. The two standard bars are shown: hollow 2,200 vertices, filled 19,500.
A thin line joins the three kinds of constraints of an order, and the name of the order is next to the points of the larger mesh."""
import numpy
from matplotlib.collections import LineCollection

import records
from drawing import bench_records, style
from records import entries

levels = (("L1", 32e3), ("L2", 512e3), ("L3", 8e6), ("memory", 256e6))  # working sets for the caches of current processors
peaks = {"f32": "fma_gflops_f32", "f64": "fma_gflops_f64"}


def bandwidth_gb_s(memory, size):
    """Interpolates linearly in the logarithm of the working set, like the benchmark."""
    return numpy.interp(numpy.log(size), [numpy.log(point["bytes"]) for point in memory], [point["gb_s"] for point in memory])


def draw_roof(axes, limits, precision):
    """Returns the roofs: the peak alone, and for each level its bandwidth and the point at which it meets the peak."""
    peak = limits[peaks[precision]]
    intensity = numpy.geomspace(0.1, 100, 200)
    rows = [{"shown": "roof", "precision": precision, "roof": "multiply-add", "gflops": peak}]
    for name, size in levels:
        bandwidth = bandwidth_gb_s(limits["memory"], size)
        roof = numpy.column_stack([intensity, numpy.minimum(peak, bandwidth * intensity)])
        axes.add_collection(LineCollection([roof], colors="#808080", linewidths=0.7))  # a limit has no values for the pointer
        text = f"{name}\n{bandwidth:.0f}{' GB/s' if name == 'memory' else ''}"
        axes.annotate(text, (peak / bandwidth, peak * 1.08), fontsize=6, color="#606060", ha="center", va="bottom")
        rows.append({"shown": "roof", "precision": precision, "roof": name, "gb_s": bandwidth, "flops_per_byte": peak / bandwidth,
                     "gflops": peak})
    axes.annotate(f"multiply-add {peak:.0f} GFLOP/s", (95, peak * 0.9), fontsize=6, color="#606060", ha="right", va="top")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(0.1, 100)
    axes.set_ylim(peak / 500, peak * 2.5)
    axes.set_xlabel("operations a byte")
    axes.set_ylabel("useful GFLOP/s")
    return rows


def draw_points(axes, mesh, precision, filled):
    rows = []
    for timing in bench_records.timings(mesh):
        if timing["precision"] != precision or "roofline" not in timing:
            continue
        color, _ = bench_records.orders[timing["variant"]]
        places = sorted((timing["roofline"][name]["flops_per_byte"], timing["roofline"][name]["gflops"]) for name in bench_records.classes)
        axes.add_collection(LineCollection([places], colors=color, linewidths=0.7))  # the values belong to its points
        for name, marker in bench_records.classes.items():
            point = timing["roofline"][name]
            axes.plot(point["flops_per_byte"], point["gflops"], marker, color=color, markerfacecolor=color if filled else "none",
                      markersize=4, markeredgewidth=0.8)
            rows.append({"shown": "kernel", "vertices": mesh["mesh"]["vertices"], "order": timing["variant"], "precision": precision,
                         "constraints": name, **point})
    return rows


def name_orders(axes, rows):
    """Writes the names to the right of all points, each at the height of its order's largest value, and separated from each other."""
    most = {}
    for row in sorted(rows, key=lambda row: row["gflops"]):
        most[row["order"]] = row["flops_per_byte"], row["gflops"]
    right, above = 1.6 * max(row["flops_per_byte"] for row in rows), 0.0
    for order, place in sorted(most.items(), key=lambda item: item[1][1]):
        color, _ = bench_records.orders[order]
        above = max(place[1], 1.35 * above)
        axes.annotate(bench_records.names[order], place, (right, above), fontsize=6, va="center",
                      arrowprops={"arrowstyle": "-", "color": color, "linewidth": 0.5, "shrinkA": 0, "shrinkB": 3},
                      bbox={"color": "white", "pad": 0.3})


def add_legend(figure, axes):
    for name, marker in bench_records.classes.items():
        axes.plot([], [], marker, color="#404040", markerfacecolor="none", label=name, markersize=4)
    style.legend_above(figure, columns=5)


def roofline(results, figures):
    record = bench_records.read(results)
    meshes = record["meshes"][:2]
    figure, axes = style.panels(1, 2, height_in=2.9)
    behind, roofs = [], []
    for panel, precision in zip(axes[0], peaks):
        roofs += draw_roof(panel, record["context"]["limits_of_one_core"], precision)
        shown = [f"{fill} {mesh['mesh']['vertices']:,} vertices" for fill, mesh in zip(("hollow", "filled"), meshes)]
        panel.set_title(f"{precision}, one thread; {', '.join(shown)}", fontsize=7)
        for mesh, filled in zip(meshes, (False, True)):
            drawn = draw_points(panel, mesh, precision, filled)
            behind += drawn
        if drawn:
            name_orders(panel, drawn)
    if not behind:
        raise records.RecordsMissing(f"{results / 'bench' / 'bench.json'}: no timing of one thread")
    add_legend(figure, axes[0][0])
    style.save(figure, figures / "roofline", entries.origin_of(results, "roofline"), style.aligned(behind + roofs))
