"""The common style of all figures: the size that a phone shows whole, colours, axes, keys and files. looks.toml has the
colour, marker and line of each deformer, and the colours of all else.

    figure, axes = style.panels(1, 2)
    style.plot(axes[0][0], rows, "angle_deg", "volume_change_pct", **style.as_of("pbs"))
    style.save(figure, figures / "volume", provenance, rows)
"""
import csv
import textwrap

import matplotlib

matplotlib.use("Agg")
from matplotlib import font_manager, pyplot, ticker  # noqa: E402

import records  # noqa: E402
from drawing import hover_titles  # noqa: E402
from records import whole_file  # noqa: E402
from words import looks  # noqa: E402

width_in = 3.9  # of every figure: where a phone shows it 366 pixels wide, its letters have 9 pixels

ink, indigo, rose, teal, sand, cyan, wine, olive, grey, light, pale = (looks.palette[name] for name in (
    "ink", "indigo", "rose", "teal", "sand", "cyan", "wine", "olive", "grey", "light", "pale"))
label_size, tick_size = 7.5, 6.5  # of all letters in a figure [pt]

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": label_size, "axes.titlesize": label_size, "axes.labelsize": label_size,
    "legend.fontsize": label_size, "xtick.labelsize": tick_size, "ytick.labelsize": tick_size,
    "lines.linewidth": 1.2, "lines.markersize": 3.2, "axes.linewidth": 0.6,
    "xtick.major.width": 0.6, "ytick.major.width": 0.6, "axes.grid": True, "grid.linewidth": 0.3, "grid.color": light,
    "axes.axisbelow": True, "legend.frameon": False, "savefig.dpi": 300, "pdf.fonttype": 42, "svg.fonttype": "none",
    "svg.hashsalt": "pbskin", "axes.spines.top": False, "axes.spines.right": False,
    # Browsers set letters a little wider.
    "figure.constrained_layout.use": True, "figure.constrained_layout.h_pad": 0.07,
    "figure.constrained_layout.w_pad": 0.055})

sequence = [(rose, "v"), (indigo, "o"), (teal, "^"), (wine, "D"), (sand, "s"), (cyan, "P"), (ink, "x")]
lines = [*looks.lines.values(), "-", looks.lines["dashed"]]


def need_font():
    """Raises RecordsMissing if the figures' font is not installed; matplotlib would use one of other widths."""
    font, = matplotlib.rcParams["font.family"]
    try:
        font_manager.findfont(font, fallback_to_default=False)
    except ValueError:
        raise records.RecordsMissing(f"the font {font} is not installed; on Debian: apt-get install "
                                     "fonts-dejavu-core") from None


def panels(rows, columns, height_in=2.0, width_in=width_in, height_ratios=None, width_ratios=None, **options):
    options["gridspec_kw"] = {"height_ratios": height_ratios, "width_ratios": width_ratios}
    return pyplot.subplots(rows, columns, figsize=(width_in, height_in * rows), squeeze=False, **options)


def stacked(*rows):
    """Rows of panels, each with a number of columns and a height [in] and its own layout; returns the axes of each
    row."""
    figure = pyplot.figure(figsize=(width_in, sum(height for _, height in rows)))
    parts = figure.subfigures(len(rows), 1, height_ratios=[height for _, height in rows])
    return figure, [part.subplots(1, columns, squeeze=False)[0] for part, (columns, _) in zip(parts, rows)]


def plot(axes, rows, x, y, **options):
    """Draws these two columns of the rows."""
    axes.plot(records.numbers(rows, x), records.numbers(rows, y), **options)


def as_of(deformer, **others):
    """The look of a deformer as options of a line, and other options, which take precedence."""
    look = looks.of(deformer)
    return {"color": look.color, "linestyle": look.line, "marker": look.marker, "label": looks.short(deformer)} | others


def draw(axes, deformer, rows, x, y, **options):
    """The line of one deformer, with a marker about every tenth point."""
    plot(axes, rows, x, y, **as_of(deformer, markevery=max(1, len(rows) // 9), **options))


def draw_series(axes, number, rows, x, y, bars=None, **options):
    """The number-th line of several that belong to no deformer; bars: the columns of lower and upper ends for each
    point."""
    color, marker = sequence[number % len(sequence)]
    plot(axes, rows, x, y, **{"color": color, "marker": marker, "linestyle": lines[number % len(lines)]} | options)
    if bars:
        axes.vlines(records.numbers(rows, x), *(records.numbers(rows, end) for end in bars), color=color, linewidth=0.7)


def label(axes, above=(), left=(), below=()):
    """Titles above the first row of panels, and names to the left of the first column and below the last row."""
    for panel, text in zip(axes[0], above):
        panel.set_title(text)
    for panels, text in zip(axes, left):
        panels[0].set_ylabel(text)
    for panel, text in zip(axes[-1], below):
        panel.set_xlabel(text)


def name_rows(axes, names, **options):
    """Names the places 0, 1, ... of the vertical axis, from the top to the bottom."""
    axes.set_yticks(range(len(names)), [textwrap.fill(name, 26) for name in names], **options)
    axes.set_ylim(len(names) - 0.5, -0.5)


def log_scale(axis, values=None, steps=(1, 2, 5)):
    """A logarithmic axis with plain numbers at these values, or at these steps of each decade."""
    axis.axes.set_xscale("log") if axis is axis.axes.xaxis else axis.axes.set_yscale("log")
    axis.set_major_locator(ticker.FixedLocator(values) if values is not None else ticker.LogLocator(subs=steps))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(ticker.NullLocator())


def decades(axis):
    """A logarithmic axis with plain numbers at whole decades only, if more would overlap; the ticks between have no
    labels."""
    log_scale(axis, steps=(1,))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:,g}"))
    axis.set_minor_locator(ticker.LogLocator(subs=range(2, 10)))
    axis.set_minor_formatter(ticker.NullFormatter())


def per_cent_scale(axes, signed):
    """Linear up to the paper's 0.5 % and logarithmic beyond, so that 0.1 % and 100 % can be read from the same axis."""
    axes.set_yscale("symlog", linthresh=0.5, linscale=0.7)
    low, high = axes.get_ylim()
    steps = [0.5, 2, 10, 100, 1000] if high - low > 25 else [0.5, 1, 2, 5, 10, 20]
    ticks = [0, *steps, *(-step for step in steps)]
    axes.yaxis.set_major_locator(ticker.FixedLocator([tick for tick in ticks if low <= tick <= high]))
    text = ((lambda value, _: f"{value:+g}".replace("-", "\u2212") if value else "0") if signed
            else (lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_formatter(ticker.FuncFormatter(text))
    axes.yaxis.set_minor_locator(ticker.NullLocator())


def key_below(figure):
    """The common key of all panels below them: every label that occurs, once, in as many columns as fit."""
    shown = {}
    for panel in figure.axes:
        for handle, label in zip(*panel.get_legend_handles_labels()):
            shown.setdefault(textwrap.fill(label, 56), handle)
    for columns in range(min(len(shown), 4), 0, -1):
        key = figure.legend(shown.values(), shown, loc="lower center", bbox_to_anchor=(0.5, 0), ncol=columns,
                            borderpad=0.6, borderaxespad=0, fontsize=tick_size, labelspacing=0.35, columnspacing=1.2,
                            handlelength=2.4)
        box = key.get_window_extent(figure.canvas.get_renderer())
        if box.width <= figure.bbox.width:
            break
        if columns > 1:
            key.remove()
    bottom = box.height / figure.bbox.height
    figure.get_layout_engine().set(rect=(0, bottom, 1, 1 - bottom))


def break_words(figure):
    """Breaks titles and names of axes into lines that are no longer than their panel."""
    figure.draw_without_rendering()  # computes the sizes of the panels
    for axes in figure.axes:
        beside = {axes.title: axes.bbox.width, axes._left_title: axes.bbox.width, axes.xaxis.label: axes.bbox.width,
                  axes.yaxis.label: axes.bbox.height}
        for text, room in beside.items():
            # A no-break space keeps a unit with its quantity.
            box, words = text.get_window_extent(), text.get_text().replace(" %", "\u00a0%").replace(" [", "\u00a0[")
            length = box.height if text is axes.yaxis.label else box.width
            if length > room and "$" not in words:
                longest = max(map(len, words.splitlines()))
                text.set_text("\n".join(textwrap.fill(line, max(8, int(longest * room / length)))
                                        for line in words.splitlines()))


def spread(wanted, heights, low, high):
    """The middles of labels of these heights, from the lowest to the highest, as near as possible to the wanted ones
    without overlap: labels that push each other have their mean place (pooled adjacent violators)."""
    below = [sum(heights[:place]) + height / 2 for place, height in enumerate(heights)]
    pools = []
    for middle, under in zip(wanted, below):
        pools.append((middle - under, 1))
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (one, of_one), (other, of_other) = pools.pop(), pools.pop()
            pools.append(((one * of_one + other * of_other) / (of_one + of_other), of_one + of_other))
    free = [max(low, min(place, high - sum(heights))) for place, count in pools for _ in range(count)]
    return [place + under for place, under in zip(free, below)]


def label_ends(axes, texts):
    """Labels to the right of a panel, when the figure is complete but for them; texts: line -> text. A thin line leads
    to the right end of each line."""
    axes.figure.canvas.figure.draw_without_rendering()  # computes the height of the panel
    ends = {line: max(line.get_transform().transform(line.get_xydata()).tolist()) for line, text in texts.items()
            if text and len(line.get_xydata())}
    lines = sorted(ends, key=lambda line: ends[line][1])
    heights = [(1.22 * texts[line].count("\n") + 1.45) * tick_size * axes.figure.dpi / 72 for line in lines]
    middles = spread([ends[line][1] for line in lines], heights, axes.bbox.y0,
                     max(axes.bbox.y1, axes.bbox.y0 + sum(heights)))
    for line, middle in zip(lines, middles):
        axes.annotate(texts[line], axes.transAxes.inverted().transform(ends[line]),
                      (1.05, (middle - axes.bbox.y0) / axes.bbox.height), xycoords="axes fraction",
                      textcoords="axes fraction", va="center", fontsize=tick_size, color=line.get_color(),
                      annotation_clip=False, arrowprops={"arrowstyle": "-", "color": line.get_color(), "linewidth": 0.4,
                                                         "shrinkA": 0, "shrinkB": 2, "relpos": (0, 0.5)})


def name_area(axes, text, place, **options):
    """A name within a grey area of a panel, at a place in data coordinates."""
    axes.annotate(text, place, **{"xycoords": ("axes fraction", "data"), "fontsize": tick_size,
                                  "va": "center"} | options)


def show(panel, picture, title="", below=""):
    """A still without axes, its title above and its facts below."""
    panel.imshow(picture, interpolation="antialiased")
    panel.set(xticks=[], yticks=[], title=title, xlabel=below)
    panel.spines[:].set_visible(False)
    panel.grid(False)


def signed(text):
    """The number with a typographic minus sign."""
    return text.replace("-", "\u2212")


def bar(figure, axes, scale, colors, label, extend="neither"):
    """One colour bar below all panels, which leave the top free."""
    figure.get_layout_engine().set(rect=(0, 0, 1, 0.985))
    shades = matplotlib.cm.ScalarMappable(scale, colors)
    figure.colorbar(shades, ax=axes, location="bottom", shrink=0.5, aspect=40, extend=extend, pad=0.01).set_label(label)


def ratio_bar(figure, axes, scale, colors):
    label = "volume ratio of a tet, deformed over rest [1]; inverted tets in dark red, in grey the darkest"
    bar(figure, axes, scale, colors, label, "both")


def bone_in_words(bone, next_to=""):
    """The name of a bone in words: left upper arm for `upper_arm.L`. The side is left out next to a bone on the same
    side."""
    name, _, side = bone.partition(".")
    known = side == next_to.partition(".")[2]
    return " ".join([*({"L": ["left"], "R": ["right"]}.get(side, []) if not known else []), *name.split("_")])


def source_of(provenance):
    """Version, revision, processor and the hashes of the shown scenes, for a file's metadata."""
    processor = f"; {provenance['cpu_model']}" if "cpu_model" in provenance else ""
    scenes = "".join(f"; scene {name} {digest}" for name, digest in provenance.get("scenes", {}).items())
    return "pbskin {} {}{}{}{}".format(provenance.get("version", "?"),
                                       provenance.get("git_revision", "unknown revision"),
                                       " (dirty)" if provenance.get("git_dirty") else "", processor, scenes)


def save(figure, stem, provenance, table, formats=("pdf", "png", "svg"), dpi=300):
    """Writes stem.pdf, stem.png and stem.svg with the revision in their metadata, and stem.csv with the rows behind the
    figure. In the SVG, every drawn point has its label and numbers as a title, which a browser shows under the
    pointer."""
    source, rights = source_of(provenance), provenance.get("rights", "")
    metadata = {"pdf": {"Title": stem.name, "Subject": source, "Keywords": rights, "CreationDate": None},
                "png": {"Title": stem.name, "Source": source, "Copyright": rights, "Software": "pbskin paper_figures"},
                "svg": {"Title": stem.name, "Source": source, "Rights": rights, "Creator": "pbskin paper_figures",
                        "Date": None}}
    break_words(figure)
    figure.draw_without_rendering()
    # The layout is computed once, so that it is the same in every format and in hover_titles.
    figure.set_layout_engine("none")
    for ending in formats:
        with whole_file.beside(stem.with_suffix("." + ending)) as path:
            figure.savefig(path, metadata=metadata[ending], dpi=150 if ending == "svg" else dpi)
            if ending == "svg":
                hover_titles.add(figure, path)
    pyplot.close(figure)
    write_table(stem.with_suffix(".csv"), table)


def write_table(file, rows):
    """The rows (dicts) as CSV; a cell is empty if its row has no such column."""
    with whole_file.beside(file) as path, open(path, "w", newline="") as stream:
        writer = csv.DictWriter(stream, list(dict.fromkeys(column for row in rows for column in row)), restval="",
                                lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def taken(rows, columns, **first):
    """The rows with only these columns, after others that all of them have in common."""
    return [first | {name: row[name] for name in columns} for row in rows]


def columns_of(rows, *names):
    """The rows of metrics.csv with only these columns, for the CSV behind a figure."""
    return taken(rows, ("scene", "deformer", "variant", "iterations", "frame", "time_s", *names))
