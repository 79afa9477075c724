"""The distribution of the human's volume change over the clip: the change of each bone's and each joint's region, in per cent of the whole
body, mean over frames. LBS loses volume at shoulders, spine and hips; what PBS still loses lies along the spine."""
import records
from drawing import style
from records import entries
from words import looks

deformers = ("lbs", "dqs", "pbs", "nh_p1")
columns = {"run", "deformer", "kind", "bone", "second_bone", "rest_share_pct", "change_pct", "own_change_pct"}
run_shown = "human_01_01"
most_regions = 10


def largest(rows):
    """The regions that LBS changes most, the largest loss first."""
    of_lbs = [row for row in rows if row["deformer"] == "lbs"]
    of_lbs.sort(key=lambda row: -abs(float(row["change_pct"])))
    return [bones_of(row) for row in of_lbs[:most_regions]]


def bones_of(row):
    """The bone of the region, or the two bones of a joint."""
    return tuple(row[column] for column in ("bone", "second_bone") if row[column])


def in_words(bones):
    """The name of a bone, or of the two bones of a joint with their side only once."""
    first, *second = bones
    return "\u2013".join([style.bone_in_words(first), *(style.bone_in_words(bone, first) for bone in second)])


def draw_kind(axes, rows):
    regions = largest(rows)
    behind = []
    for deformer in deformers:
        shown = sorted((row for row in rows if row["deformer"] == deformer and bones_of(row) in regions),
                       key=lambda row: regions.index(bones_of(row)))
        look = looks.of(deformer)
        axes.plot(records.numbers(shown, "change_pct"), [regions.index(bones_of(row)) for row in shown], linestyle="none", color=look.color,
                  marker=look.marker, markersize=4, label=look.name)
        behind += [{name: row[name] for name in row if name in columns} for row in shown]
    axes.axvline(0, color=style.black, linewidth=0.6)
    axes.set_yticks(range(len(regions)), list(map(in_words, regions)))
    axes.set_ylim(len(regions) - 0.5, -0.5)
    axes.set_xlabel("change [% of the body's volume]")
    return behind


def volume_by_region(results, figures):
    file = results / "volume" / "regions.csv"
    rows = [row for row in records.table(file, columns) if row["run"] == run_shown and row["deformer"] in deformers]
    if not rows:
        raise records.RecordsMissing(f"{file}: no rows of {run_shown}")
    figure, axes = style.panels(1, 2, height_in=2.3)
    behind = []
    for panel, kind, title in zip(axes[0], ("bone", "joint"), ("by nearest bone", "blended between two bones")):
        behind += draw_kind(panel, [row for row in rows if row["kind"] == kind])
        panel.set_title(f"human, {title}")
    style.legend_above(figure)
    style.save(figure, figures / "volume_by_region", entries.origin_of(results, "volume_by_region"), behind)
