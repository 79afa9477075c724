"""Draws the first picture of the README: the jumping human in its crouch under LBS and DQS, each with the weights of
Eq. 2 and with smooth weights, under PBS and under the finite element reference, coloured by the distance of the skin
from the reference. From two runs:

    pbskin run human_01_01 -o PAPER --set motion.rate_hz=25 --set motion.duration_s=1.68 --set 'output.frames=[41]' \\
        --set 'output.frame_names=["crouch"]' --set 'deformers.use=["lbs","dqs","pbs","nh_p1"]'
    pbskin run human_01_01 -o SMOOTH (the same) --set skinning.weights=diffused \\
        --set 'deformers.use=["lbs","dqs","nh_p1"]'
    # writes same_pose.png and same_pose.csv, the numbers in it
    xvfb-run -a python3 paper_figures/readme/same_pose.py PAPER SMOOTH

The kept records have no frames. The rows of the first run must agree with the records.
"""
import math
import pathlib
import sys

import numpy
from matplotlib import colors
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import vtkDataSetMapper

own = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(own.parent))

import records  # noqa: E402
from drawing import rendering, style  # noqa: E402
from records import kept, whole_file  # noqa: E402

kept_rows = kept.opened(own.parents[1] / "experiments" / "records" / "full") / "volume" / "human_01_01"
picture = own / "same_pose.png"
compared = ("volume_change_pct", "inverted_tets", "error_joint_pct")
stated = (*compared, "skin_rms_mm")
time_s, frame, reference = 1.64, 41, "nh_p1"
# Weights, deformer and title of each panel.
panels = (("Eq. 2", "lbs", "LBS\nweights of Eq. 2"), ("smooth", "lbs", "LBS\nsmooth weights"),
          ("Eq. 2", "dqs", "DQS\nweights of Eq. 2"), ("smooth", "dqs", "DQS\nsmooth weights"),
          ("Eq. 2", "pbs", "PBS\n24 iterations"), ("Eq. 2", reference, "FEM\nthe reference"))
size_m, width_px = 1.7, 1260  # the body's largest extent at rest, to which distances refer, as in skin_rms_mm
scale = colors.Normalize(0.0, 50.0)  # [mm]
shades = colors.LinearSegmentedColormap.from_list("distance", ["#D9D9D9", "#F5C04A", "#D55E00", "#7A0018"])
view_direction = (0.75, 0.12, 1.0)  # from the body to the camera


def row_of(folder, deformer):
    """The row of this frame in the metrics.csv of a run or a kept record; the default form of PBS, which is not the
    only one there."""
    rows = [row for row in records.table(folder / "metrics.csv", {"deformer", "variant", "order", "iterations",
                                                                  "time_s", *compared})
            if (row["deformer"], row["variant"]) == (deformer, "default") and row["iterations"] in ("", "24")
            and row["order"] in ("", "ordered") and math.isclose(row.number("time_s"), time_s, abs_tol=1e-6)]
    records.need(rows, f"{folder / 'metrics.csv'}: no row of {deformer} at {time_s} s")
    return rows[0]


def checked_row(folder, deformer):
    """The row of the run, after a check that it agrees with the kept record to the six digits that are kept."""
    run, record = row_of(folder, deformer), row_of(kept_rows, deformer)
    for column in compared:
        if not math.isclose(record.number(column), run.number(column), rel_tol=1e-5, abs_tol=1e-9):
            raise records.RecordsMissing(f"{folder / 'metrics.csv'}: {column} of {deformer} = {run[column]}: "
                                         f"expected {record[column]}, as in {kept_rows / 'metrics.csv'}")
    return run


def surface(folder, deformer):
    return rendering.read(folder / "frames" / f"{deformer}_surface_{frame:06}.vtp")


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def skin(folder, deformer, unit_m):
    """The skin, with the colour of its distance from the reference. unit_m: metres of the body per metre of one of 1.7
    m."""
    data = surface(folder, deformer)
    distances = numpy.linalg.norm(points_of(data) - points_of(surface(folder, reference)), axis=1)
    values = numpy_to_vtk(1000.0 / unit_m * distances, deep=True)
    values.SetName("distance_mm")
    data.GetPointData().SetScalars(values)
    smooth = rendering.made(vtkPolyDataNormals, InputData=data, Splitting=0)
    table = rendering.table_of(scale.vmin, scale.vmax, [shades(step / 255) for step in range(256)])
    mapper = rendering.made(vtkDataSetMapper, InputData=rendering.output_of(smooth), LookupTable=table)
    mapper.UseLookupTableScalarRangeOn()
    return rendering.actor_of(mapper, ambient=0.35, Specular=0.0)


def below(row):
    inverted = int(row["inverted_tets"])
    if row["deformer"] == reference:
        return style.signed(f"volume {row.number('volume_change_pct'):+.1f} %")
    return style.signed(f"volume {row.number('volume_change_pct'):+.1f} %\n{row.number('skin_rms_mm'):.0f} mm "
                        "from FEM\n"
                        f"{inverted} inverted tet{'' if inverted == 1 else 's'}")


def draw(folders):
    """The figure and the rows whose numbers it shows."""
    low, high = rendering.bounds_of(folders["Eq. 2"] / "surface_rest.vtp")
    unit_m = max(high - low) / size_m
    low, high = rendering.bounds_of(folders["Eq. 2"] / "frames" / f"{reference}_surface_{frame:06}.vtp")
    view = rendering.Camera(tuple((low + high) / 2), 0.53 * (high - low)[1], view_direction)
    figure, axes = style.panels(1, len(panels), width_in=9.0, height_in=4.0)
    shown = []
    for panel, (weights, deformer, title) in zip(axes[0], panels):
        row = (checked_row if weights == "Eq. 2" else row_of)(folders[weights], deformer)
        stage = rendering.Stage(540, 960)
        style.show(panel, stage.shot([skin(folders[weights], deformer, unit_m)], view), title, below(row))
        panel.title.set_size(10)
        panel.xaxis.label.set_size(9)
        shown.append({"weights": weights, "deformer": deformer, "time_s": f"{time_s:g}",
                      **{column: f"{row.number(column):.6g}" for column in stated}})
    style.bar(figure, axes, scale, shades, f"distance of the skin from FEM [mm], on a body of {size_m} m", "max")
    figure.axes[-1].xaxis.label.set_size(9)
    return figure, shown


def save(figure, rows):
    with whole_file.beside(picture) as path:
        figure.savefig(path, dpi=width_px / figure.get_figwidth(), metadata={"Software": "pbskin paper_figures"})
    style.write_table(picture.with_suffix(".csv"), rows)


def main(arguments):
    if len(arguments) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        save(*draw(dict(zip(("Eq. 2", "smooth"), map(pathlib.Path, arguments[1:])))))
    except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
        print(f"same_pose: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
