"""The human jumping under LBS, PBS and FEM side by side, as an animated WebP at the clip's own speed, and as one still."""
from xml.sax.saxutils import escape

import matplotlib
from PIL import Image, ImageDraw, ImageFont

from drawing import bodies, rendering, style
from records import recorded_frames, whole_file
from words import looks

scene, deformers, still = "human_jump", ("lbs", "pbs", "nh_p1"), 8
pixels, direction, half_height_m, floor_to_middle_m, margin_px = (300, 440), (0.9, 0.15, 1.0), 1.0, 0.96, 40
xmp = ('<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description '
       'xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:source>{source}</dc:source><dc:rights>{rights}</dc:rights></rdf:Description>'
       "</rdf:RDF></x:xmpmeta>")


def camera(frames, frame):
    low, high = rendering.bounds_of(frames.skin("nh_p1", frame))
    middle = (low + high) / 2
    return rendering.Camera((middle[0], floor_to_middle_m, middle[2]), half_height_m, direction)


def words(frames, label, frame):
    row = frames.row(label, frame)
    change = style.signed(f"{float(row['volume_change_pct']):+.1f} %")
    return f"{looks.of(label).name}\nvolume {change}, {row['inverted_tets']} inverted"


def picture(frames, frame, stage, font):
    """The three bodies, with the name and the volume change above each, and the time below."""
    view, (width, height) = camera(frames, frame), pixels
    page = Image.new("RGB", (width * len(deformers), height + 2 * margin_px), "white")
    pen = ImageDraw.Draw(page)
    for column, label in enumerate(deformers):
        page.paste(Image.fromarray(stage.shot([bodies.skin(frames.skin(label, frame))], view)), (column * width, margin_px))
        pen.text((column * width + 10, 4), words(frames, label, frame), fill="black", font=font)
    pen.text((10, height + margin_px + 10), f"{float(frames.row('lbs', frame)['time_s']):.2f} s", fill="black", font=font)
    return page


def draw_clip(file, frames, origin):
    font = ImageFont.truetype(matplotlib.font_manager.findfont("DejaVu Sans"), 13)
    stage, times_s = rendering.Stage(*pixels, background=rendering.paper), frames.times_s()
    pages = [picture(frames, frame, stage, font) for frame in range(len(times_s))]
    step_ms = round(1000 * (times_s[-1] - times_s[0]) / (len(times_s) - 1))
    with whole_file.beside(file) as path:
        pages[0].save(path, save_all=True, append_images=pages[1:], duration=step_ms, loop=0, quality=80,
                      xmp=xmp.format(source=escape(style.source_of(origin)), rights=escape(origin["rights"])).encode())


def draw_still(frames):
    stage = rendering.Stage(700, 800, background=rendering.paper)
    low, high = rendering.bounds_of(frames.skin("nh_p1", still))
    view = rendering.Camera((low + high) / 2, 0.78, direction)
    figure, axes = style.panels(1, len(deformers), height_in=3.0)
    for panel, label in zip(axes[0], deformers):
        name, facts = words(frames, label, still).split("\n")
        style.show(panel, stage.shot([bodies.skin(frames.skin(label, still))], view), name, facts)
    return figure


def clip_jump_facts(rows):
    """The largest number of inverted tets of each deformer over the clip, and whether the finite elements have some in every frame."""
    inverted = {label: [int(row["inverted_tets"]) for row in rows if row["deformer"] == label] for label in deformers}
    fem = inverted["nh_p1"]
    return {label: max(found) for label, found in inverted.items()} | {"fem_frames": f"{sum(map(bool, fem))} of {len(fem)}"}


def clip_jump(results, figures):
    frames = recorded_frames.Frames(results, scene)
    origin = recorded_frames.origin_of(frames)
    draw_clip(figures / "clip_jump.webp", frames, origin)
    behind = [frames.row(label, frame) for label in deformers for frame in range(len(frames.times_s()))]
    style.save(draw_still(frames), figures / "clip_jump", origin,
               style.columns_of(behind, "volume_change_pct", "inverted_tets", "min_section_pct"))
