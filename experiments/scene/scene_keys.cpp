#include "experiments/scene/scene.hpp"

namespace experiments {
namespace {

using enum KeyType;

SceneKey key(std::string table, std::string name, KeyType type, std::string default_json, std::string unit, std::string meaning)
{
    return {.table = std::move(table),
            .name = std::move(name),
            .type = type,
            .default_json = std::move(default_json),
            .unit = std::move(unit),
            .meaning = std::move(meaning)};
}
SceneKey within(SceneKey entry, double lowest, double highest)
{
    entry.lowest = lowest;
    entry.highest = highest;
    return entry;
}
SceneKey one_of(SceneKey entry, std::vector<std::string> choices)
{
    entry.choices = std::move(choices);
    return entry;
}

}  // namespace

std::vector<SceneKey> character_and_motion_keys()
{
    std::vector<std::string> bodies = {""};
    for (const pbs::NamedBody& body : pbs::named_bodies()) bodies.push_back(body.name);
    return {
        within(key("", "schema", integer, "", "", "version of this format"), 1, 1),
        one_of(key("character", "body", text, "\"\"", "",
                   "built-in limb, bar or ring (with a handle), human (MakeHuman's body from Debian's assimp-testmodels), or man, lady, "
                   "frankie (`pbskin fetch`); empty: from files"),
               bodies),
        key("character", "model", text, "\"\"", "",
            "rigged model, relative to the scene: .glb .gltf .fbx .dae .zae; its surface is meshed, and its joints are the skeleton"),
        within(key("character", "scale", number, "1.0", "", "factor by which a model is enlarged, for files that state a wrong unit"), 1e-6,
               1e6),
        key("character", "mesh", text, "\"\"", "", "tet mesh file, relative to the scene: .msh .vtu .vtk .mesh .ele"),
        key("character", "skeleton", text, "\"\"", "",
            "skeleton file, relative to the scene: .toml with [[joint]] tables, or the joints of a clip or a rig "
            "(.bvh .gltf .glb .fbx .dae); with a model, only for one without joints: such a file, or human, the skeleton of that body"),
        within(
            key("character", "skeleton_scale", number, "1.0", "m", "metres per unit of the skeleton file; for CMU's clips 0.0254 / 0.45"),
            above_zero, 1e6),
        within(key("character", "vertices", integer, "0", "", "wanted number of vertices of a named body or a model; 0: its own default"),
               0, 1e7),
        within(key("character", "refine", integer, "0", "",
                   "number of times that every tet is cut into eight (8 or 64 times as many tets); the sizes of the bones stay, and the "
                   "metrics "
                   "are those of the finer mesh"),
               0, 2),
        key("motion", "joint", text, "\"\"", "", "the joint that a sweep turns"),
        key("motion", "axis", vec3, "[1.0, 0.0, 0.0]", "", "axis of a sweep in rest world axes"),
        within(key("motion", "angle_deg", number, "0.0", "deg", "angle of a sweep's last frame; frame i has angle_deg * i / (frames - 1)"),
               -7200, 7200),
        within(key("motion", "frames", integer, "18", "", "number of frames of a sweep, including the rest pose"), 2, 1e6),
        key("motion", "clip", text, "\"\"", "",
            "motion capture clip: relative to the scene, or by name from Debian's assimp-testmodels (01_01.bvh)"),
        key("motion", "animation", text, "\"\"", "",
            "an animation of character.model by name; without this key, a joint or a clip the model's first one"),
        key("motion", "allow_partial", boolean, "false", "", "accepts a clip of which fewer than half of the moving joints match a bone"),
        within(key("motion", "start_s", number, "0.0", "s", "start of the motion in the clip, without the T-pose of its first frame"), 0,
               1e6),
        within(key("motion", "duration_s", number, "0.0", "s", "duration of the motion; 0: to the end of the clip"), 0, 1e6),
        within(key("motion", "rate_hz", number, "100.0", "1/s", "frames per second; a frame is a whole number of steps pbs.time_step_s"),
               1e-3, 1e5),
        within(key("pbs", "time_step_s", number, "0.01", "s",
                   "time step of Algorithm 1; by default the longest one of at most 10 ms that divides a frame of a clip or an animation"),
               1e-9, 1e3),
        key("skinning", "weights", text, "\"\"", "",
            "paper (Eq. 2), rigid (nearest bone), smooth (Eq. 2 with smooth transitions), diffused (Eq. 2 smoothed over the mesh's edges), "
            "artist (of character.model), or a CSV file vertex,joint,weight; empty: artist for a model with joints, paper for all others"),
    };
}

std::vector<SceneKey> output_keys()
{
    return {
        key("reference", "name", text, "\"\"", "", "the deformer that errors are measured against; empty: none"),
        one_of(key("reference", "error_bar", text, "\"none\"", "",
                   "also estimates the discretisation error of the reference: orders (solves it again with the other element order on the "
                   "same tets; cheap for order 2), refined (on tets cut into eight), both (four solutions, from which the order of "
                   "convergence is observed; with two it is presumed); the method is in run.json"),
               names_of_options<ErrorBar>()),
        key("deformers", "use", texts, "[\"lbs\", \"pbs\"]", "",
            "what moves the character: names of `pbskin list deformers` and of the [[fem]] tables"),
        within(key("output", "frames_every", integer, "1", "", "write every n-th frame as VTU; 0: none"), 0, 1e9),
        within(key("output", "frames", integers, "[]", "", "further frames to write, by number"), 0, 1e9),
        key("output", "frame_names", texts, "[]", "", "titles of `frames`, in the same order"),
        key("output", "glb", boolean, "false", "",
            "also writes the surface of each deformer over the written frames as frames/LABEL.glb, which Blender opens; the character "
            "needs a rendered surface"),
        key("output", "metrics", texts, "[\"all\"]", "",
            "groups of metrics beyond the volume columns: errors, sections, surface, all; [] leaves them out"),
    };
}

}  // namespace experiments
