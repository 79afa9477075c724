"""Stills of the human jumping under LBS, PBS and neo-Hookean finite elements: the skin, and the tets coloured by their volume ratio. The
text below each states the number of inverted tets and the smallest limb cross-section (100 %: as at rest)."""
import numpy

import records
from drawing import rendering, style
from records import pose_reached, recorded_frames
from words import looks
from words.number_words import span

pixels = (560, 800)  # size of a still
most_stills = 4


def files_of(run, deformer):
    """The tet file of each frame. Names of PBS files contain the iterations, as in pbs_24_000054.vtu."""
    names = {"pbs": ["pbs_24", "pbs"]}.get(deformer, [deformer])
    for name in names:
        files = sorted((run.folder / "frames").glob(f"{name}_[0-9][0-9][0-9][0-9][0-9][0-9].vtu"))
        if files:
            return {int(file.stem[-6:]): file for file in files}
    raise records.RecordsMissing(f"{run.folder / 'frames'}: no {names[0]}_*.vtu")


def skin_of(tet_file):
    return tet_file.with_name(tet_file.stem[:-6] + "surface" + tet_file.stem[-7:] + ".vtp")


def caption(row):
    section = f"\nsmallest section {float(row['min_section_pct']):.0f} %" if row.get("min_section_pct") else ""
    inverted = row["inverted_tets"]
    return f"{inverted} inverted tet{'' if inverted == '1' else 's'}{section}{pose_reached.mark(row)}"


def half_height_of(boxes):
    """Half of the height that a still shows [m]: the tallest and widest body with a margin."""
    height_m = max((high - low)[1] for low, high in boxes)
    width_m = max(numpy.hypot(*(high - low)[[0, 2]]) for low, high in boxes)
    return 0.54 * max(height_m, width_m * pixels[1] / pixels[0])


def evenly(frames):
    """As many frames as are shown, evenly spaced from the first to the last."""
    if len(frames) <= most_stills:
        return frames
    return [frames[number * (len(frames) - 1) // (most_stills - 1)] for number in range(most_stills)]


def draw_stills(rows, files, frames, file_of, colour_bar):
    """Draws one row per deformer and one column per frame, all with one camera that follows the LBS body."""
    stage = rendering.Stage(*pixels)
    boxes = {frame: rendering.bounds_of(files["lbs"][frame]) for frame in frames}
    half_height_m = half_height_of(boxes.values())
    figure, axes = style.panels(len(files), len(frames), height_in=2.35)
    for panels, deformer in zip(axes, files):
        for panel, frame in zip(panels, frames):
            panel.imshow(stage.picture(file_of(files[deformer][frame]), sum(boxes[frame]) / 2, half_height_m))
            panel.set(xticks=[], yticks=[], xlabel=caption(rows[deformer][frame]))
            panel.spines[:].set_visible(False)
            panel.grid(False)
        panels[0].set_ylabel(looks.of(deformer).name, fontsize=8)
    for panel, frame in zip(axes[0], frames):
        panel.set_title(f"{float(rows['lbs'][frame]['time_s']):.2f} s")
    if colour_bar:
        style.ratio_bar(figure, axes, rendering.ratio_scale, rendering.ratio_colors)
    return figure


def frames_skin_facts(rows):
    """The range of the number of inverted tets over the stills, for each deformer."""
    inverted = {}
    for row in rows:
        inverted.setdefault(row["deformer"], []).append(int(row["inverted_tets"]))
    lbs, pbs, reference = inverted.values()
    return {"lbs": span(lbs), "pbs": span(pbs), "reference": span(reference)}


frames_volume_ratio_facts = frames_skin_facts


def frames_skin(results, figures):
    draw_figure(results, figures / "frames_skin", skin_of, colour_bar=False)


def frames_volume_ratio(results, figures):
    draw_figure(results, figures / "frames_volume_ratio", lambda file: file, colour_bar=True)


def draw_figure(results, stem, file_of, colour_bar):
    recorded = recorded_frames.Frames(results, "human_jump")
    run = recorded.run
    deformers = ["lbs", "pbs", run.reference()]
    files = {deformer: files_of(run, deformer) for deformer in deformers}
    frames = evenly(sorted(set.intersection(*(set(found) for found in files.values()))))
    if not frames:
        raise records.RecordsMissing(f"{run.folder / 'frames'}: no frame that all of {', '.join(deformers)} have")
    rows = {deformer: {int(row["frame"]): row for row in run.select(deformer, 24 if deformer == "pbs" else None)} for deformer in deformers}
    behind = style.columns_of([rows[deformer][frame] for deformer in deformers for frame in frames], "volume_change_pct", "inverted_tets",
                              "min_section_pct")
    style.save(draw_stills(rows, files, frames, file_of, colour_bar), stem, recorded_frames.origin_of(recorded), behind)
