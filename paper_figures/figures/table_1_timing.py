"""The paper's Table 1 compared with the times measured here on meshes matched to its counts: a drawn table, its CSV and its LaTeX. The
paper prints two times that exclude each other, a frame rate and a CT of 100 steps; the table shows both as milliseconds per frame. Our
milliseconds are processor time, our frame rates wall-clock time."""
import records
from drawing import style
from records import entries, whole_file

orders = (("plain", "f64"), ("ordered", "f32"))  # in the order of the mesh file; and the default of this code
columns = {"model": "model", "mesh": "mesh here", "vertices": "vertices\npaper / here", "edges": "edges\npaper / here",
           "tets": "tets\npaper / here", "paper_frames_per_s": "paper\n[fps]", "plain_f64_frames_per_s": "plain f64\nwall [fps]",
           "ordered_f32_frames_per_s": "ordered f32\nwall [fps]", "paper_ms": "paper, by\nits fps [ms]",
           "paper_ct_ms": "paper, by\nits CT [ms]", "plain_f64_ms": "plain f64\nCPU [ms]", "ordered_f32_ms": "ordered f32\nCPU [ms]"}
widths = (0.07, 0.08, 0.1, 0.115, 0.115, 0.055, 0.075, 0.085, 0.08, 0.08, 0.075, 0.085)  # widths of the columns, relative to the page


def matched(results):
    """The rows of the meshes that correspond to a row of Table 1: model -> (order, precision) -> row. The paper's own body takes precedence
    over a body that substitutes it."""
    needed = {"mesh", "model", "stands_in", "variant", "precision", "total_ms", "frames_per_s", "paper_ms", "paper_ct_ms", "cpu_model"}
    rows = [row for row in records.table(results / "timing" / "timing.csv", needed) if row["model"] not in ("", "-")]
    if not rows:
        raise records.RecordsMissing(f"{results / 'timing' / 'timing.csv'}: no mesh matched to Table 1")
    models = {}
    for row in sorted(rows, key=lambda row: row["stands_in"] != "0"):
        mesh = models.setdefault(row["model"], {"mesh": row["mesh"]})
        if mesh["mesh"] == row["mesh"]:
            mesh[row["variant"], row["precision"]] = row
    return models


def counts(row):
    """The count as printed and as meshed."""
    return {name: f"{float(row[name]) / float(row[f'{name}_over_table_1']):.0f} / {row[name]}" for name in ("vertices", "edges", "tets")}


def line_of(model, mesh):
    timed = {f"{order}_{precision}": mesh[order, precision] for order, precision in orders if (order, precision) in mesh}
    if len(timed) < len(orders):
        raise records.RecordsMissing(f"timing.csv, {mesh['mesh']}: not timed in {' and '.join(' '.join(order) for order in orders)}")
    first = timed["plain_f64"]
    paper = {"paper_ms": f"{float(first['paper_ms']):.1f}", "paper_ct_ms": f"{float(first['paper_ct_ms']):.2f}",
             "paper_frames_per_s": f"{float(first['paper_frames_per_s']):.1f}"}
    here = {f"{name}_ms": f"{float(row['total_ms']):.2f}" for name, row in timed.items()}
    here |= {f"{name}_frames_per_s": f"{float(row['frames_per_s']):.0f}" for name, row in timed.items()}
    found = {"model": model, "mesh": first["body"], **counts(first), **paper, **here}
    return {name: found[name] for name in columns}


def latex(lines, cpu):
    head = " & ".join(text.replace("\n", " ") for text in columns.values())
    body = "\n".join(" & ".join(line.values()).replace("_", r"\_") + r" \\" for line in lines)
    return (f"% timed on one core of {cpu}; the paper: Intel i5 2.50 GHz, 2014\n"
            f"\\begin{{tabular}}{{ll{'r' * (len(columns) - 2)}}}\n\\toprule\n"
            f"{head} \\\\\n\\midrule\n{body}\n\\bottomrule\n\\end{{tabular}}\n")


def drawn(lines):
    figure, axes = style.panels(1, 1, height_in=0.5 + 0.19 * len(lines), width_in=style.page_in)
    axes[0, 0].axis("off")
    table = axes[0, 0].table([list(line.values()) for line in lines], colLabels=list(columns.values()), colWidths=widths, loc="center",
                             cellLoc="right", edges="horizontal")
    table.auto_set_font_size(False)
    table.set_fontsize(6)
    for (row, column), cell in table.get_celld().items():
        cell.set_linewidth(0.8 if row == 0 else 0.3)
        if column < 2:
            cell.set_text_props(ha="left")
        cell.PAD = 0.03
    return figure


def table_1_timing(results, figures):
    models = matched(results)
    lines = [line_of(model, mesh) for model, mesh in models.items()]
    cpu = next(iter(models.values()))["plain", "f64"]["cpu_model"]
    style.save(drawn(lines), figures / "table_1_timing", entries.origin_of(results, "table_1_timing"), lines)
    with whole_file.beside(figures / "table_1_timing.tex") as path:
        path.write_text(latex(lines, cpu))
