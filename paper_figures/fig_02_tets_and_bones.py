"""The paper's Fig. 2: the tet mesh, cut open in front of the skeleton: the human standing (walk, first frame) and the limb at rest."""
import bodies
import recorded_frames
import rendering
import style

limb_view = rendering.Camera((0, 0, 0), 0.33, (0.1, 0.3, 1.0))


def opened(frames, data, points, towards, view, rod_m):
    """The tets behind their bones; what was cut away as glass; the bones before it all."""
    ahead_m = (points - frames.projections(0)) @ towards
    return [bodies.cut_open(data, ahead_m), bodies.glass(data), *bodies.bones(frames.bones(0), rod_m, view.direction)]


def human(frames):
    file = frames.tets("pbs", 0)
    low, high = rendering.bounds_of(file)
    forward, left = recorded_frames.heading_of(frames.bones(0))
    view = rendering.Camera((low + high) / 2, 0.8, forward + 0.35 * left + (0, 0.1, 0))
    actors = opened(frames, rendering.read(file), bodies.points_of(file), forward, view, 0.009)
    return rendering.Stage(960, 1200, background=rendering.paper).shot(actors, view)


def limb(frames):
    file = frames.tets("lbs", 0)
    actors = opened(frames, bodies.at_rest(file), bodies.rest_positions_of(file), (0.0, 0.0, 1.0), limb_view, 0.012)
    return rendering.Stage(1500, 420, background=rendering.paper).shot(actors, limb_view)


def counts(frames):
    character = frames.run.record["character"]
    return {"scene": frames.run.name, **{name: character[name] for name in ("vertices", "tets", "bones")}}


def facts(frames):
    return "{vertices} vertices, {tets} tets, {bones} bones".format(**counts(frames))


def draw(results, figures):
    walk, bent = (recorded_frames.Frames(results, scene) for scene in ("human_walk", "limb_bend"))
    figure, axes = style.panels(1, 2, height_in=3.4, width_ratios=(1, 1.3))
    style.show(axes[0, 0], human(walk), "human, standing", facts(walk))
    style.show(axes[0, 1], limb(bent), "limb, at rest", facts(bent))
    style.save(figure, figures / "fig_02_tets_and_bones", recorded_frames.origin_of(walk, bent), [counts(walk), counts(bent)])
