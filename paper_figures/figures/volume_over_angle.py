"""The volume change of each deformer as the limb is twisted and bent: signed (the paper's measure) and absolute (in which gains do not hide
losses)."""
import records
from drawing import style
from records import entries

scenes = [("limb_twist", "twist"), ("limb_bend", "bend")]
measures = [("volume_change_pct", "signed volume\nchange [%]"), ("volume_abs_change_pct", "absolute volume\nchange [%]")]


def volume_over_angle(results, figures):
    figure, axes = style.panels(2, 2, height_in=1.9, sharex="col")
    behind = []
    for column, (scene, motion) in enumerate(scenes):
        run = records.Run(results / "volume" / scene)
        deformers = {"lbs": None, "dqs": None, "pbs": 24, run.reference(): None}
        for deformer, iterations in deformers.items():
            rows = run.select(deformer, iterations)
            angle_deg = records.numbers(rows, "angle_deg")
            for row, (measure, _) in enumerate(measures):
                style.draw(axes[row][column], deformer, angle_deg, records.numbers(rows, measure))
            behind += style.columns_of(rows, "angle_deg", *(measure for measure, _ in measures))
        axes[0][column].set_title(f"limb, {motion}")
        axes[1][column].set_xlabel(f"{motion} angle [degrees]")
        axes[1][column].xaxis.set_major_locator(style.ticker.MultipleLocator(30))
    for row, (_, label) in enumerate(measures):
        axes[row][0].set_ylabel(label)
        for panel in axes[row]:
            style.paper_band(panel, signed=row == 0)
            style.per_cent_scale(panel, signed=row == 0)
    style.legend_above(figure, columns=3)
    style.save(figure, figures / "volume_over_angle", entries.origin_of(results, "volume_over_angle"), behind)
