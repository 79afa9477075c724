"""The figure of the README: error against run time in the mean over the evaluated poses, from the kept record of work_precision."""
import pathlib

from drawing import style
from figures import work_precision

picture = pathlib.Path(__file__).resolve().with_name("error_against_time")


def draw(results):
    """Writes the picture, and beside it a table of the numbers in it. Returns the lines of the README that show it."""
    panel = work_precision.panels_of("packed_f32", results)[0]
    figure, axes = style.panels(1, 1, height_in=3.4, width_in=style.page_in)
    style.label_ends(axes[0][0], work_precision.draw_panel(axes[0][0], panel))
    style.save(figure, picture, {}, work_precision.rows_behind(panel), formats=("png",))
    return [f"![Error against run time of each class of deformers](paper_figures/readme/{picture.name}.png)", "",
            f"*Error at the joints against processor time per frame on one core, {panel.title}. Each line is a class of deformers, in its "
            "best code; a filled mark is on the front of all. Below: the class that is nearest within 0.1, 1 and 10 ms.*"]
