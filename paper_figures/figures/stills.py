"""Stills of recorded bodies, rendered by VTK: the paper's Figures 1, 3, 5, 8, 9 and 10, the jump as a clip, its tets at
four moments, and folds cut open. A figure is a grid of stills, with facts from metrics.csv below each."""
from html import escape

import matplotlib
import numpy
from PIL import Image, ImageDraw, ImageFont

import records
from drawing import bodies, rendering, style
from records.recorded_frames import Frames, heading_of, middle_of
from viewer import data as viewer_data
from words import looks
from words.number_words import span

distance_scale, distance_colors = matplotlib.colors.Normalize(0, 60), matplotlib.colormaps["YlGnBu"]  # [mm]
crouch_s = 0.32  # after the first frame of human_jump
volumes = ("volume_change_pct", "volume_abs_change_pct", "inverted_tets")


class Facts:
    """The numbers of a row of metrics.csv, for a format; {s} is the ending of the inverted tets, {section} the smallest
    section if it is on record, and {mark} states a pose that was not reached."""

    def __init__(self, row):
        self.row = row

    def __getitem__(self, name):
        if name == "section":
            return f"\nsection {self['min_section_pct']:.0f} %" if self.row.get("min_section_pct") else ""
        words = {"s": "s" * (self.row["inverted_tets"] != "1"),
                 "mark": "" if records.is_reached(self.row) else "\npose not reached"}
        return words[name] if name in words else float(self.row[name])


def filled(row, words):
    return style.signed(words.format_map(Facts(row)))


def grid(stills, words, titles=(), names=(), **layout):
    """The figure and the rows behind it. stills: for each row of panels its (row of metrics.csv, picture); words: the
    facts below."""
    figure, axes = style.panels(len(stills), len(stills[0]), **layout)
    for panels, line in zip(axes, stills):
        for panel, (row, picture) in zip(panels, line):
            style.show(panel, picture, below=filled(row, words))
    style.label(axes, titles, names)
    return figure, [row for line in stills for row, _ in line]


def skins(frames, labels, views, stage):
    """A row of stills of the skin per deformer. views: frame -> camera."""
    return [[(frames.row(label, frame), stage.shot([bodies.skin(frames.skin(label, frame))], view))
             for frame, view in views.items()]
            for label in labels]


def times_of(frames, shown):
    return [f"{float(frames.row('lbs', frame)['time_s']):.2f} s" for frame in shown]


def above_floor(file, middle_m, half_height_m, direction):
    """A camera that follows the body along the floor but not upwards, so that a jump is visible."""
    x, _, z = rendering.middle_of(file)
    return rendering.Camera((x, middle_m, z), half_height_m, direction)


def fig_01_motion(results):
    """A character in motion: the human jumping under LBS, PBS, and PBS with its jiggling zone."""
    frames, labels = Frames(results, "human_jump"), ("lbs", "pbs", "pbs_jiggle")
    views = {frame: above_floor(frames.skin("lbs", frame), 0.95, 0.98, (1.0, 0.15, 0.75))
             for frame in frames.frames_at(0.0, crouch_s, 0.72, 1.08)}
    figure, behind = grid(skins(frames, labels, views, rendering.Stage(440, 720)), "{volume_change_pct:+.1f} % volume",
                          times_of(frames, views), [looks.short(label) for label in labels], height_in=1.75)
    return figure, style.columns_of(behind, *volumes)


def fig_03_two_layers(results):
    """The rendered surface at rest, after linear blend skinning and after position based dynamics. The lower row shows
    the hips."""
    frames = Frames(results, "human_jump")
    frame, = frames.frames_at(crouch_s)
    rows = [frames.row(label, frame) for label in ("lbs", "pbs")]
    rest, posed = bodies.rest_positions_of(frames.tets("lbs", frame)), bodies.points_of(frames.tets("lbs", frame))
    bodies_at = [(points.min(0) + points.max(0)) / 2 for points in (rest, posed, posed)]
    hips_at = [middle_of(points, frames.binding(), ("hip.L", "hip.R", "pelvis")) for points in (rest, posed, posed)]
    words = [filled(row, "volume {volume_change_pct:+.1f} %\n{inverted_tets:.0f} inverted tet{s}") for row in rows]
    figure, axes = style.panels(2, 3, height_in=1.6, height_ratios=(1.5, 1))
    for panels, centers, pixels, half_height_m, titles, below in (
            (axes[0], bodies_at, (640, 760), 0.88, ("rest", "step 1: LBS", "step 2: PBS, 24 iterations"), ("", "", "")),
            (axes[1], hips_at, (640, 380), 0.22, ("", "", ""), ("as given", *words))):
        stage, files = rendering.Stage(*pixels), (frames.skin_at_rest(),
                                                  *(frames.skin(label, frame) for label in ("lbs", "pbs")))
        for panel, file, center, title, text in zip(panels, files, centers, titles, below):
            style.show(panel, stage.shot([bodies.skin(file)], rendering.Camera(center, half_height_m)), title, text)
    return figure, style.columns_of(rows, *volumes)


def fig_05_weights(results):
    """The bent limb with rigid weights and with those of Eq. 2, before and after position based dynamics."""
    scenes, labels = [Frames(results, scene) for scene in ("limb_bend_rigid", "limb_bend")], ("lbs", "pbs")
    stage, view = rendering.Stage(1000, 640), rendering.Camera((-0.06, 0.08, 0), 0.29, (-0.25, 0.25, 1.0))
    shown = [(frames, frames.frame_at_angle(90)) for frames in scenes]
    stills = [[(frames.row(label, frame), stage.shot([bodies.skin(frames.tets(label, frame))], view))
               for frames, frame in shown]
              for label in labels]
    figure, behind = grid(stills, "volume {volume_change_pct:+.1f} %\n{inverted_tets:.0f} inverted tets\n"
                                  "smallest section {min_section_pct:.0f} %",
                          ("each vertex on one bone", "weights of Eq. 2"), [looks.short(label) for label in labels],
                          height_in=1.75)
    return figure, style.columns_of(behind, "angle_deg", *volumes, "min_section_pct")


# Figure 8 with a reference: each row has one camera, and all share one colour bar.
artefacts = "{volume_change_pct:+.1f} % volume\n{inverted_tets:.0f} inverted\nsection {min_section_pct:.0f} %{mark}"
twisted = rendering.Camera((0, 0, 0), 0.24, (0.0, 0.35, 1.0)), 0.62  # and the height of a still relative to its width
bent = rendering.Camera((0, 0.14, 0), 0.36, (0.0, 0.1, 1.0)), 0.9
artefact_poses = (("twist", 180, *twisted), ("twist", 170, *twisted), ("bend", 110, *bent))


def fig_08_artefacts(results):
    """The limb twisted by 180 and 170 degrees and bent by 110 degrees, with each tet coloured by its volume ratio."""
    scenes, labels, stills = {motion: Frames(results, f"limb_{motion}")
                              for motion in ("twist", "bend")}, ("lbs", "dqs", "pbs", "nh_p1"), []
    for motion, angle_deg, view, height in artefact_poses:
        frames, stage = scenes[motion], rendering.Stage(900, int(900 * height))
        frame = frames.frame_at_angle(angle_deg)
        stills.append([(frames.row(label, frame), stage.shot([rendering.tets(frames.tets(label, frame))], view))
                       for label in labels])
    figure, behind = grid(stills, artefacts, [looks.short(label) for label in labels],
                          [f"{motion} {angle_deg}\u00b0" for motion, angle_deg, *_ in artefact_poses], height_in=1.6,
                          height_ratios=[height for *_, height in artefact_poses])
    style.ratio_bar(figure, figure.axes, rendering.ratio_scale, rendering.ratio_colors)
    return figure, style.columns_of(behind, "angle_deg", *volumes, "min_section_pct")


def fig_09_jiggle(results):
    """The human walking under PBS with its jiggling zone, coloured by the distance from PBS with the same stiffness but
    without a zone. The camera turns with the hips and shows the front and the back."""
    frames, stage = Frames(results, "human_walk"), rendering.Stage(440, 680)
    compared, sides = ("pbs_jiggle", "pbs_no_zone"), {"front": 1, "back": -1}
    shown = frames.frames_at(0.0, 0.48, 1.44, 2.4)
    figure, axes = style.panels(len(sides), len(shown), height_in=1.7)
    behind = []
    for panels, frame in zip(axes.T, shown):
        away_mm, file = bodies.distances_mm(frames, frame, *compared), frames.skin("pbs_jiggle", frame)
        forward, left = heading_of(frames.bones(frame))
        for panel, sign in zip(panels, sides.values()):
            view = rendering.Camera(rendering.middle_of(file), 0.88, sign * (forward + 0.5 * left) + (0, 0.12, 0))
            style.show(panel, stage.shot([bodies.skin_by(file, away_mm, distance_scale, distance_colors)], view))
        time_s, apart = float(frames.row("pbs_jiggle", frame)["time_s"]), frames.apart(frame, *compared)
        panels[-1].set_xlabel(f"largest {apart['largest_mm']:.0f} mm")
        bone = bodies.bone_under(frames, int(away_mm.argmax()), frames.tets("pbs_jiggle", frame))
        behind.append({"scene": "human_walk", "frame": frame, "time_s": time_s, **apart, "farthest_bone": bone})
    style.label(axes, times_of(frames, shown), sides)
    jiggling, still = (viewer_data.title_of(frames, label) for label in compared)
    style.bar(figure, axes, distance_scale, distance_colors, f"distance of the skin under {jiggling}, from that under "
                                                             f"{still} [mm]", "max")
    return figure, behind


def fig_09_jiggle_facts(rows):
    """The largest distance between the two, frame by frame."""
    words = [f"{float(row['largest_mm']):.0f} mm at the {style.bone_in_words(row['farthest_bone'])} "
             f"({float(row['time_s']):.2f} s)"
             for row in rows]
    return {"farthest": ", ".join(words), "first": words[0],
            "largest": f"{max(float(row['largest_mm']) for row in rows):.0f}"}


def fig_10_start_from_lbs(results):
    """Poses with and without LBS as the initial guess. No package provides a kicking clip, so the poses are from a
    jump."""
    frames, stage = Frames(results, "human_jump"), rendering.Stage(480, 640)
    shown = frames.frames_at(0.16, crouch_s, 0.72, 1.08)
    deformers = {"pbs": "from LBS in each frame", "pbs_increment": "moved by LBS's increment"}
    views = {frame: rendering.Camera(rendering.middle_of(frames.skin("pbs", frame)), 0.87, (0.8, 0.12, 1.0))
             for frame in shown}
    figure, axes = style.panels(3, len(shown), height_in=1.75)
    behind = []
    for panels, (frame, view) in zip(axes.T, views.items()):
        for panel, ((row, picture),) in zip(panels, skins(frames, deformers, {frame: view}, stage)):
            style.show(panel, picture,
                       below=filled(row, "{volume_change_pct:+.1f} % volume\nsection {min_section_pct:.0f} %"))
            behind.append(row)
        away_mm = bodies.distances_mm(frames, frame, *deformers)
        actor = bodies.skin_by(frames.skin("pbs_increment", frame), away_mm, distance_scale, distance_colors)
        style.show(panels[2], stage.shot([actor], view),
                   below=f"largest {frames.apart(frame, *deformers)['largest_mm']:.0f} mm")
    style.label(axes, times_of(frames, shown), (*deformers.values(), "distance between the two"))
    style.bar(figure, axes, distance_scale, distance_colors, "distance between the two skins [mm]", "max")
    return figure, style.columns_of(behind, *volumes, "min_section_pct", "stretch_rms")


# The human jumping under LBS, PBS and FEM side by side, as an animated WebP at the clip's own speed, and as one still.

in_clip, clip_direction = ("lbs", "pbs", "nh_p1"), (0.9, 0.15, 1.0)
pixels, margin_px = (300, 440), 40
in_words = "volume {volume_change_pct:+.1f} %, {inverted_tets:.0f} inverted"
xmp = ('<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'
       '<rdf:Description xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:source>{source}</dc:source>'
       "<dc:rights>{rights}</dc:rights></rdf:Description></rdf:RDF></x:xmpmeta>")


def page_of_clip(frames, frame, stage, font):
    """The three bodies, with the name and the volume change above each, and the time below."""
    view, (width, height) = above_floor(frames.skin("nh_p1", frame), 0.96, 1.0, clip_direction), pixels
    page = Image.new("RGB", (width * len(in_clip), height + 2 * margin_px), "white")
    pen = ImageDraw.Draw(page)
    for column, ((row, picture),) in enumerate(skins(frames, in_clip, {frame: view}, stage)):
        page.paste(Image.fromarray(picture), (column * width, margin_px))
        name = looks.of(in_clip[column]).name
        pen.text((column * width + 10, 4), f"{name}\n{filled(row, in_words)}", fill="black", font=font)
    pen.text((10, height + margin_px + 10), *times_of(frames, [frame]), fill="black", font=font)
    return page


def draw_clip(file, frames, origin):
    font = ImageFont.truetype(matplotlib.font_manager.findfont("DejaVu Sans"), 13)
    stage, times_s = rendering.Stage(*pixels), frames.times_s()
    pages = [page_of_clip(frames, frame, stage, font) for frame in range(len(times_s))]
    step_ms = round(1000 * (times_s[-1] - times_s[0]) / (len(times_s) - 1))
    pages[0].save(file, save_all=True, append_images=pages[1:], duration=step_ms, loop=0, quality=80,
                  xmp=xmp.format(source=escape(style.source_of(origin)), rights=escape(origin["rights"])).encode())


def clip_jump_facts(rows):
    """The largest number of inverted tets of each deformer over the clip, and whether the finite elements have some in
    every frame."""
    inverted = {label: [int(row["inverted_tets"]) for row in rows if row["deformer"] == label] for label in in_clip}
    fem = inverted["nh_p1"]
    return {label: max(found) for label, found in inverted.items()} | {"fem_frames": f"{sum(map(bool, fem))} of "
                                                                                     f"{len(fem)}"}


def clip_jump(results):
    frames = Frames(results, "human_jump")
    still, = frames.frames_at(crouch_s)
    view, stage = rendering.Camera(rendering.middle_of(frames.skin("nh_p1", still)), 0.78,
                                   clip_direction), rendering.Stage(700, 800)
    stills = [line[0] for line in skins(frames, in_clip, {still: view}, stage)]
    figure, _ = grid([stills], in_words, [looks.short(label) for label in in_clip], height_in=1.9)
    behind = [frames.row(label, frame) for label in in_clip for frame in range(len(frames.times_s()))]
    return (figure, style.columns_of(behind, "volume_change_pct", "inverted_tets", "min_section_pct"),
            {"webp": lambda file, origin: draw_clip(file, frames, origin)})


moment_pixels, most_moments = (560, 800), 4
moment_words = "{inverted_tets:.0f} inverted tet{s}{section}{mark}"


def frames_volume_ratio(results):
    """The human jumping under LBS, PBS and FEM. One camera follows the LBS body and shows the tallest and widest body
    with a margin."""
    frames, stage = Frames(results, "human_jump"), rendering.Stage(*moment_pixels)
    labels, recorded = ("lbs", "pbs", frames.run.reference()), [int(row["frame"]) for row in frames.run.select("lbs")]
    written = [frame for frame in recorded if all(frames.is_written(label, frame) for label in labels)]
    records.need(written, f"{frames.folder / 'frames'}: no frame that all of {', '.join(labels)} have")
    evenly = numpy.unique(numpy.linspace(0, len(written) - 1, most_moments).astype(int))
    shown = {written[number]: rendering.bounds_of(frames.tets("lbs", written[number])) for number in evenly}
    width_m = max(numpy.hypot(*(high - low)[[0, 2]]) for low, high in shown.values())
    height_m = max((high - low)[1] for low, high in shown.values())
    half_height_m = 0.54 * max(height_m, width_m * moment_pixels[1] / moment_pixels[0])
    stills = [[(frames.row(label, frame), stage.shot([rendering.tets(frames.tets(label, frame))],
                                                     rendering.Camera(sum(box) / 2, half_height_m)))
               for frame, box in shown.items()] for label in labels]
    figure, behind = grid(stills, moment_words, times_of(frames, shown), [looks.short(label) for label in labels],
                          height_in=1.75)
    style.ratio_bar(figure, figure.axes, rendering.ratio_scale, rendering.ratio_colors)
    return figure, style.columns_of(behind, "volume_change_pct", "inverted_tets", "min_section_pct")


def frames_volume_ratio_facts(rows):
    """The range of the number of inverted tets over the stills, for each deformer."""
    inverted = {row["deformer"]: [int(of["inverted_tets"]) for of in rows if of["deformer"] == row["deformer"]]
                for row in rows}
    return dict(zip(("lbs", "pbs", "reference"), map(span, inverted.values())))


def contact(results):
    """Folds under LBS, PBS without and with contact, and FEM, cut open in the plane of the two bones of a joint."""
    labels = {label: looks.short(label) for label in ("lbs", "pbs", "pbs_contact")} | {"nh_p1": "FEM with contact"}
    stage, limb, human = rendering.Stage(700, 600), Frames(results, "limb_bend"), Frames(results, "human_jump")
    crouch, = human.frames_at(crouch_s)
    folds = {"limb, 110\u00b0": (limb, limb.frame_at_angle(110), "upper", "forearm", 0.24),
             "elbow": (human, crouch, "upper_arm.R", "forearm_upper.R", 0.09),
             "knee": (human, crouch, "thigh.L", "shin.L", 0.13)}
    stills = []
    for frames, frame, parent, child, half_height_m in folds.values():
        ends = {bone.name: bone for bone in frames.bones(frame)}
        joint = ends[child].head
        arms = [arm / numpy.linalg.norm(arm) for arm in (ends[parent].head - joint, ends[child].tail - joint)]
        normal, inward = numpy.cross(*arms), sum(arms) / numpy.linalg.norm(sum(arms))
        view = rendering.Camera(joint + 0.35 * half_height_m * inward, half_height_m, normal, tuple(inward))
        stills.append([(frames.row(label, frame), stage.shot([bodies.section(frames.tets(label, frame), joint, normal)],
                                                             view))
                       for label in labels])
    figure, behind = grid(stills, "error {error_joint_pct:.1f} %", labels.values(), folds, height_in=1.25)
    return figure, style.columns_of(behind, "error_joint_pct", "inverted_tets")
