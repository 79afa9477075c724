"""Wall-clock time per frame on one core over the size of the mesh, for three kernels, and the parts of a frame on the meshes that represent
the paper's. Crosses mark the paper's frame rates and stars its column CT over 100 steps; the two differ by a factor of 20. All times can be
compared with 33 ms at the paper's sizes."""
import records
from drawing import style
from records import entries
from words import looks

kernels = {("plain", "f64"): "plain, f64", ("plain", "f32"): "plain, f32", ("ordered", "f32"): "ordered, f32"}
parts = {"lbs_ms": ("LBS", looks.of("lbs").color, ""), "bind_ms": ("bind", style.yellow, "////"), "stretch_ms": ("stretch", style.sky, ""),
         "volume_ms": ("volume", style.blue, "...."), "rest_ms": ("rest", "#BBBBBB", "")}
columns = {"mesh", "body", "variant", "precision", "vertices", "tets", "total_wall_ms", "total_wall_ms_low", "total_wall_ms_high",
           "paper_ms", "paper_ct_ms", *parts}


def of_kernel(rows, variant, precision):
    return sorted((row for row in rows if (row["variant"], row["precision"]) == (variant, precision)), key=lambda row: int(row["vertices"]))


def draw_sizes(axes, rows):
    for number, (kernel, label) in enumerate(kernels.items()):
        shown = of_kernel(rows, *kernel)
        bars = records.numbers(shown, "total_wall_ms_low"), records.numbers(shown, "total_wall_ms_high")
        style.draw_series(axes, number, records.numbers(shown, "vertices"), records.numbers(shown, "total_wall_ms"), label, bars)
    paper = [row for row in shown if row["paper_ms"]]
    for column, marker, label in (("paper_ms", "x", "paper, by frame rate"), ("paper_ct_ms", "*", "paper, by CT")):
        axes.plot(records.numbers(paper, "vertices"), records.numbers(paper, column), linestyle="none", marker=marker, color=style.black,
                  markersize=5, label=label)
    axes.axhline(1000 / 30, color=style.black, linewidth=0.6)
    axes.annotate("30 frames/s", (1150, 1000 / 27), fontsize=6)
    style.decades(axes.xaxis)
    style.log_scale(axes.yaxis)
    axes.set_xlabel("vertices")
    axes.set_ylabel("wall-clock time per frame [ms]")


def draw_parts(axes, rows, variant, precision):
    """The parts of a frame, end to end, on the meshes that represent the paper's."""
    shown = [row for row in of_kernel(rows, variant, precision) if row["paper_ms"]]
    left = [0.0] * len(shown)
    for column, (label, color, hatch) in parts.items():
        part_ms = records.numbers(shown, column)
        axes.barh(range(len(shown)), part_ms, left=left, color=color, hatch=hatch, height=0.7, label=label, edgecolor="white",
                  linewidth=0.3)
        left = [low + more for low, more in zip(left, part_ms)]
    axes.set_yticks(range(len(shown)), [f"{row['body']}, {int(row['vertices']):,}" for row in shown], fontsize=6)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("processor time per frame [ms]")
    axes.set_title(kernels[variant, precision])


def timing_sizes(results, figures):
    folder = results / "timing"
    rows = [row for row in records.table(folder / "timing.csv", columns) if (row["variant"], row["precision"]) in kernels]
    figure, axes = style.panels(1, 3, height_in=2.3)
    draw_sizes(axes[0][0], rows)
    draw_parts(axes[0][1], rows, "plain", "f64")
    draw_parts(axes[0][2], rows, "ordered", "f32")
    style.legend_above(figure, columns=5)
    behind = [{name: row[name] for name in sorted(columns)} for row in rows]
    style.save(figure, figures / "timing_sizes", entries.origin_of(results, "timing_sizes"), behind)
