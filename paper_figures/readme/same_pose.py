"""Draws a picture of the README: the limb twisted and bent under LBS, DQS, PBS and the finite element reference, from two runs.

    pbskin run limb_twist -o TWIST --set 'deformers.use=["lbs","dqs","pbs","nh_p2"]' --set output.frames_every=6
    pbskin run limb_bend -o BEND --set 'deformers.use=["lbs","dqs","pbs","nh_p1"]' --set output.frames_every=4
    xvfb-run -a python3 paper_figures/readme/same_pose.py TWIST BEND     # writes same_pose.png and same_pose.csv, the numbers in it

The kept records have no frames. The runs' rows must agree with the records.
"""
import math
import pathlib
import sys
from dataclasses import dataclass

own = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(own.parent))

import records  # noqa: E402
from drawing import rendering, style  # noqa: E402
from records import kept, whole_file  # noqa: E402
from words import looks  # noqa: E402

kept_volume = kept.opened(own.parents[1] / "experiments" / "records" / "full") / "volume"
picture = own / "same_pose.png"
compared = ("volume_change_pct", "volume_abs_change_pct", "inverted_tets")
titles = {name: looks.of(name).name for name in ("lbs", "dqs", "pbs")}
titles |= {"pbs": f"{titles['pbs']}, 24 iterations", "reference": "FEM (the reference)"}
width_px = 1500


@dataclass(frozen=True)
class Pose:
    scene: str
    angle_deg: float
    reference: str  # the deformer that serves as the reference
    title: str
    camera: rendering.Camera
    height: float  # height of a panel, relative to its width


poses = (Pose("limb_twist", 150.0, "nh_p2", "twisted by 150\u00b0", rendering.Camera((0, 0, 0), 0.19, (0.0, 0.35, 1.0)), 0.5),
         Pose("limb_bend", 100.0, "nh_p1", "bent by 100\u00b0", rendering.Camera((-0.02, 0.11, 0), 0.33, (0.0, 0.1, 1.0)), 0.8))


def row_of(folder, pose, deformer):
    """The row of this pose in the metrics.csv of a run or a kept record."""
    rows = [row for row in records.table(folder / "metrics.csv", {"deformer", "variant", "iterations", "angle_deg", *compared})
            if row["deformer"] == deformer and row["variant"] == "default" and row["iterations"] in ("", "24")]
    records.need(rows, f"{folder / 'metrics.csv'}: no rows of {deformer}")
    return records.at_angle(rows, pose.angle_deg)


def checked_row(folder, pose, deformer):
    """The row of the run, after a check that it agrees with the kept record to the six digits that are kept."""
    run = row_of(folder, pose, deformer)
    record = row_of(kept_volume / pose.scene, pose, deformer)
    for column in compared:
        if not math.isclose(record.number(column), run.number(column), rel_tol=1e-5, abs_tol=1e-9):
            raise records.RecordsMissing(f"{folder / 'metrics.csv'}: {column} of {deformer} = {run[column]}: expected {record[column]}, "
                                         f"as in {kept_volume / pose.scene / 'metrics.csv'}")
    return run


def draw_panel(panel, pose, folder, row):
    frame = folder / "frames" / f"{row['deformer']}_{int(row['frame']):06}.vtu"
    stage = rendering.Stage(900, int(900 * pose.height))
    inverted = int(row["inverted_tets"])
    below = f"volume {row.number('volume_change_pct'):+.1f} %, {inverted} inverted tet{'' if inverted == 1 else 's'}"
    style.show(panel, stage.shot([rendering.tets(frame)], pose.camera), below=style.signed(below))
    panel.xaxis.label.set_size(9)


def draw(folders):
    """The figure and the rows whose numbers it shows."""
    figure, axes = style.panels(len(poses), len(titles), width_in=9.0, height_in=1.9, height_ratios=[pose.height for pose in poses])
    shown = []
    for panels, pose, folder in zip(axes, poses, folders):
        for panel, deformer in zip(panels, titles):
            shown.append(checked_row(folder, pose, pose.reference if deformer == "reference" else deformer))
            draw_panel(panel, pose, folder, shown[-1])
        panels[0].set_ylabel(pose.title, fontsize=10)
    for panel, title in zip(axes[0], titles.values()):
        panel.set_title(title, fontsize=11)
    label = "volume of a tet over its volume at rest (blue: squeezed, yellow: swollen, dark red: inverted)"
    style.bar(figure, axes, rendering.ratio_scale, rendering.ratio_colors, label, "both")
    figure.axes[-1].xaxis.label.set_size(9)
    return figure, [{"scene": row["scene"], "deformer": row["deformer"], "angle_deg": row["angle_deg"],
                     **{column: f"{row.number(column):.6g}" for column in compared}} for row in shown]


def save(figure, rows):
    with whole_file.beside(picture) as path:
        figure.savefig(path, dpi=width_px / figure.get_figwidth(), metadata={"Software": "pbskin paper_figures"})
    style.write_table(picture.with_suffix(".csv"), rows)


def main(arguments):
    if len(arguments) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        save(*draw([pathlib.Path(folder) for folder in arguments[1:]]))
    except (records.RecordsMissing, whole_file.CannotBeWritten) as error:
        print(f"same_pose: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
