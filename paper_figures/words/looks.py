"""The name, colour, marker and line of each deformer, from looks.toml: the same in every figure, on every page and in
the viewer.

    look = looks.of("dqs")        # look.name, look.color, look.marker, look.line
"""
import itertools
import pathlib
import tomllib
import zlib
from dataclasses import dataclass

lines = {"solid": "-", "dashed": (0, (4, 1.5)), "dash-dotted": (0, (5, 1.2, 1, 1.2)), "dotted": (0, (1, 1)),
         "short-dashed": (0, (3, 1))}
listed = tomllib.loads((pathlib.Path(__file__).resolve().parents[1] / "looks.toml").read_text(encoding="utf-8"))
palette = listed.pop("palette")
# Colours, markers and lines of deformers that are not listed; no listed deformer has such a colour.
own = list(itertools.product(palette["own"], ("X", "H", ">", "8", "|", "_", "p"), ("solid", "dashed", "dash-dotted")))


@dataclass(frozen=True)
class Look:
    name: str
    color: str
    marker: str
    line: object  # a line style of matplotlib


def of(deformer):
    """The look of a deformer, by its label or the name of its kind. One that is not listed, such as a user's own, has
    its label as its name and a look that depends on nothing else."""
    if deformer not in listed:
        color, marker, line = own[zlib.crc32(deformer.encode()) % len(own)]
        return Look(deformer, color, marker, lines[line])
    shown = listed[listed[deformer].get("group", deformer)]
    return Look(listed[deformer]["name"], shown["color"], shown["marker"], lines[shown["line"]])


def short(deformer):
    return listed.get(deformer, {}).get("short") or of(deformer).name


def in_order(names):
    """These deformers in the order of the list; those that are not listed come last."""
    return [name for name in listed if name in names] + sorted(set(names) - set(listed))
