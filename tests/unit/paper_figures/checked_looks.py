"""Importing this module makes style.save refuse a figure in which a line, whose label begins with the name of a
deformer, has another marker or colour than looks.toml states; in which anything has a colour that is not in looks.toml,
or letters another size than the two of style.py; or in which two labels of a panel overlap. The tests that draw figures
import it."""
import itertools
import re
import unittest.mock

from drawing import style
from matplotlib import colors, text
from words import looks

by_name = {name: deformer for deformer in looks.listed for name in (looks.of(deformer).name, looks.short(deformer))}
palette = looks.palette.values(), [look["color"] for look in looks.listed.values() if "color" in look]
allowed = {color for value in itertools.chain(*palette)
           for color in ([value] if isinstance(value, str) else value)} | {"#FFFFFF"}


def hex_of(color):
    return colors.to_hex(color).upper()


def deformer_of_label(label):
    """The deformer whose name begins a label, e.g. PBS for `PBS, k_stretch 0.2` and for `PBS (baseline)`."""
    names = [name for name in by_name if re.match(re.escape(name) + r"(?![\w-])", label)]
    return by_name[max(names, key=len)] if names else None


def wrongly_drawn(figure):
    found = []
    for axes in figure.axes:
        for line in axes.lines:
            deformer = deformer_of_label(str(line.get_label()))
            color = hex_of(line.get_color())
            if deformer and (color not in (looks.of(deformer).color, style.light)
                             or line.get_marker() not in (looks.of(deformer).marker, "None")):
                found.append(f"{line.get_label()}: {color.lower()} {line.get_marker()}")
    return found


def strange_colors(figure):
    """The colours of lines, marks, areas and words that looks.toml does not have. Those of a scale (a colour bar) are
    not compared."""
    found = set()
    for axes in (axes for axes in figure.axes if axes.get_label() != "<colorbar>"):
        for line in axes.lines:
            found |= {line.get_color(), *([line.get_markerfacecolor(), line.get_markeredgecolor()]
                                          if line.get_marker() != "None" else [])}
        for area in axes.collections:
            if area.get_array() is None:
                found |= {tuple(color) for color in (*area.get_facecolor(), *area.get_edgecolor())}
        for patch in axes.patches:
            found |= {patch.get_facecolor(), patch.get_edgecolor()}
        found |= {words.get_color() for words in axes.texts}
    return sorted({hex_of(color) for color in found if colors.to_rgba(color)[3]} - allowed)


def strange_sizes(figure):
    shown = [words for words in figure.findobj(text.Text) if words.get_visible() and words.get_text()]
    return sorted({words.get_fontsize() for words in shown} - {style.label_size, style.tick_size})


def overlaps(figure):
    """The pairs of labels of a panel of which one covers a part of the other."""
    figure.draw_without_rendering()  # computes the places of all words
    found = []
    for axes in (axes for axes in figure.axes if axes.get_visible()):
        words = [axes.title, axes.xaxis.label, axes.yaxis.label, *axes.texts,
                 *(axes.get_legend().get_texts() if axes.get_legend() else ())]
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            words += [name for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high
                      for name in (tick.label1, tick.label2)]
        boxes = [(one.get_text(), text.Text.get_window_extent(one).padded(-1)) for one in words if one.get_visible()
                 and one.get_text()]
        found += [f"{one} | {other}" for (one, box), (other, its) in itertools.combinations(boxes, 2)
                  if box.overlaps(its)]
    return found


def save_checked(figure, stem, *rest, save=style.save, **options):
    style.break_words(figure)
    for words, wrong in (("not drawn as in looks.toml", wrongly_drawn(figure)),
                         ("no colour of looks.toml", strange_colors(figure)),
                         ("no size of letters of style.py", strange_sizes(figure)),
                         ("labels that overlap", overlaps(figure))):
        if wrong:
            raise AssertionError(f"{stem.name}: {words}: {', '.join(map(str, wrong))}")
    figure.set_layout_engine("none")  # what was checked is saved: its layout and words are not computed again
    with unittest.mock.patch.object(style, "break_words"):
        save(figure, stem, *rest, **{"dpi": 60, **options})


style.save = save_checked
