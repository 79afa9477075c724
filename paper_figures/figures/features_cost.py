"""The cost of each switch of a scene: the ratio of processor time with it to that without it, per frame and per step, on the limb and the
human. Bars show the spread over the runs. A switch with a ratio above 1 costs time, one below 1 saves time, and one at 1 is free."""
import records
from drawing import style
from records import entries
from words import case_words

measures = [("frame_cpu_ms_ratio", "processor time per frame, with over without [1]"),
            ("step_cpu_ms_ratio", "processor time per step, with over without [1]")]
scenes = ("limb", "human")
columns = {"feature", *(measure + part for measure, _ in measures for part in ("", "_lower", "_upper"))}


def draw_scene(axes, rows, measure, number, names):
    shown = [row for row in rows if row[measure]]
    places = [names.index(row["feature"]) + (number - 0.5) * 0.3 for row in shown]
    values = records.numbers(shown, measure)
    color, marker = style.sequence[number]
    axes.hlines(places, records.numbers(shown, measure + "_lower"), records.numbers(shown, measure + "_upper"), color=color, linewidth=0.8)
    axes.plot(values, places, linestyle="none", color=color, marker=marker, markersize=3.5, label=scenes[number])


def features_cost(results, figures):
    found = {scene: records.table(results / "timing" / f"features_{scene}" / "features.csv", columns) for scene in scenes}
    names = list(dict.fromkeys(row["feature"] for rows in found.values() for row in rows))
    figure, axes = style.panels(1, 2, height_in=0.7 + 0.14 * len(names), sharey=True)
    for panel, (measure, label) in zip(axes[0], measures):
        for number, rows in enumerate(found.values()):
            draw_scene(panel, rows, measure, number, names)
        panel.axvline(1, color=style.black, linewidth=0.6)
        style.log_scale(panel.xaxis)
        panel.set_xlabel(label)
    axes[0][0].set_yticks(range(len(names)), [case_words.of_field("feature", name) for name in names])
    axes[0][0].set_ylim(len(names) - 0.5, -0.5)
    style.legend_above(figure)
    behind = [{"scene": scene} | {name: row[name] for name in sorted(columns)} for scene, rows in found.items() for row in rows]
    style.save(figure, figures / "features_cost", entries.origin_of(results, "features_cost"), behind)
