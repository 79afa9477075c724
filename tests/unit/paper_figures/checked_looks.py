"""Importing this module makes style.save refuse a figure in which a line, whose label begins with the name of a deformer, has another
colour or marker than looks.toml states. The tests that draw figures import it."""
import re

from drawing import style
from matplotlib import colors
from words import looks

by_name = {looks.of(deformer).name: looks.of(deformer) for deformer in looks.listed}


def look_of_label(label):
    """The look of the deformer whose name begins a label, e.g. PBS for `PBS, k_stretch 0.2` and for `PBS (baseline)`."""
    names = [name for name in by_name if re.match(re.escape(name) + r"(?![\w-])", label)]
    return by_name[max(names, key=len)] if names else None


def wrongly_drawn(figure):
    found = []
    for axes in figure.axes:
        for line in axes.lines:
            look = look_of_label(str(line.get_label()))
            if look and (colors.to_hex(line.get_color()).upper() != look.color or line.get_marker() not in (look.marker, "None")):
                found.append(f"{line.get_label()}: {colors.to_hex(line.get_color())} {line.get_marker()}")
    return found


def save_checked(figure, stem, *rest, save=style.save, **options):
    wrong = wrongly_drawn(figure)
    if wrong:
        raise AssertionError(f"{stem.name}: not drawn as in looks.toml: {', '.join(wrong)}")
    save(figure, stem, *rest, **options)


style.save = save_checked
