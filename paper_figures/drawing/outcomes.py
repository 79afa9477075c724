"""The look of the five outcomes of the stability study: darker is worse, and each has its own marker for grey prints."""
from drawing import style

looks = {"converged": ("#FFFFFF", "o", style.blue, "converged: at rest, as if undisturbed"),
         "bounded": ("#E3EEF7", "s", style.sky, "bounded: moving, or at rest elsewhere"),
         "inverted": ("#F6CFA0", "v", style.vermillion, "inverted tets at the end"),
         "diverged": ("#C08A9F", "x", style.black, "diverged"),
         "not_finite": ("#5A5A5A", "*", style.yellow, "not finite")}


def draw_marks(axes, places, outcomes, size):
    """places: (x, y) of each outcome."""
    for outcome, (_, marker, color, text) in looks.items():
        shown = [place for place, found in zip(places, outcomes) if found == outcome]
        if shown:
            fill = {"c": color, "edgecolors": style.black} if marker == "*" else {"color": color}  # yellow alone is not visible on white
            axes.scatter(*zip(*shown), s=size * (3.5 if marker == "*" else 1), marker=marker, **fill,
                         linewidths=0.3 if marker == "*" else 0.9, label=text, zorder=3)


def legend(figure, axes):
    """A legend of all five outcomes, so that a reader sees which do not occur."""
    for _, marker, color, text in looks.values():
        axes.plot([], [], linestyle="none", marker=marker, color=color, markeredgecolor=style.black if marker == "*" else color,
                  markeredgewidth=0.6 if marker == "*" else 0.8, markersize=9 if marker == "*" else 4.5, label=text)
    style.legend_above(figure, columns=3)
