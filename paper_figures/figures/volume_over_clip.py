"""The volume change of each deformer over the clip on the human, compared with neo-Hookean finite elements."""
import records
from drawing import style
from records import entries

measures = [("volume_change_pct", "signed volume\nchange [%]"), ("volume_abs_change_pct", "absolute volume\nchange [%]")]


def volume_over_clip(results, figures):
    run = records.Run(results / "volume" / "human_01_01")
    figure, axes = style.panels(2, 1, height_in=1.7, width_in=style.page_in, sharex=True)
    behind = []
    for deformer, iterations in {"lbs": None, "dqs": None, "pbs": 24, run.reference(): None}.items():
        rows = run.select(deformer, iterations)
        time_s = records.numbers(rows, "time_s")
        for panel, (measure, _) in zip(axes[:, 0], measures):
            style.draw(panel, deformer, time_s, records.numbers(rows, measure), linewidth=0.8)
        behind += style.columns_of(rows, *(measure for measure, _ in measures))
    for number, (panel, (_, label)) in enumerate(zip(axes[:, 0], measures)):
        style.paper_band(panel, signed=number == 0)
        style.per_cent_scale(panel, signed=number == 0)
        panel.set_ylabel(label)
        panel.margins(x=0)
    axes[1][0].set_xlabel("time in the clip [s]")
    style.legend_above(figure)
    style.save(figure, figures / "volume_over_clip", entries.origin_of(results, "volume_over_clip"), behind)
