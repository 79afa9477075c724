"""The paper's Fig. 2, the tet mesh cut open in front of the skeleton: human and limb at rest, with the human inside the rendered
surface."""
from drawing import bodies, rendering, style
from records import recorded_frames

limb_view = rendering.Camera((0, 0, 0), 0.33, (0.1, 0.3, 1.0))


def opened(frames, skin, towards, view, rod_m):
    """The tets at rest behind their bones, with a transparent skin and the bones in front."""
    file, bones = frames.tets("lbs", 0), frames.bones_at_rest()
    ahead_m = (bodies.rest_positions_of(file) - frames.projections(bones)) @ towards
    return [bodies.cut_open(bodies.at_rest(file), ahead_m), bodies.glass(skin), *bodies.bones(bones, rod_m, view.direction)]


def human(frames):
    skin = frames.skin_at_rest()
    low, high = rendering.bounds_of(skin)
    forward, left = recorded_frames.heading_of(frames.bones_at_rest())
    view = rendering.Camera((low + high) / 2, 0.54 * (high - low)[1], forward + 0.35 * left + (0, 0.1, 0))
    return rendering.Stage(1100, 1200, background=rendering.paper).shot(opened(frames, rendering.read(skin), forward, view, 0.009), view)


def limb(frames):
    actors = opened(frames, bodies.at_rest(frames.tets("lbs", 0)), (0.0, 0.0, 1.0), limb_view, 0.012)
    return rendering.Stage(1500, 420, background=rendering.paper).shot(actors, limb_view)


def counts(frames):
    character = frames.run.record["character"]
    return {"scene": frames.run.name, **{name: character[name] for name in ("vertices", "tets", "bones")}}


def facts(frames):
    return "{vertices} vertices, {tets} tets, {bones} bones".format(**counts(frames))


def fig_02_tets_and_bones(results, figures):
    walk, bent = (recorded_frames.Frames(results, scene) for scene in ("human_walk", "limb_bend"))
    figure, axes = style.panels(1, 2, height_in=3.4, width_ratios=(1, 1.3))
    style.show(axes[0, 0], human(walk), "human, at rest", facts(walk))
    style.show(axes[0, 1], limb(bent), "limb, at rest", facts(bent))
    style.save(figure, figures / "fig_02_tets_and_bones", recorded_frames.origin_of(walk, bent), [counts(walk), counts(bent)])
