// The keys of a scene: one entry each with type, default, unit, range and meaning. Those of the deformers are with the
// deformers.
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"

namespace experiments {
namespace {

using enum KeyType;
using Keys = OptionFields<OutputSpec>;  // of keys that are not stored in one member

}  // namespace

const OptionFields<pbs::CharacterSource>& character_fields()
{
    using Source = pbs::CharacterSource;
    std::vector<std::string> bodies = {""};
    for (const pbs::NamedBody& body : pbs::named_bodies()) bodies.push_back(body.name);
    static const OptionFields<Source> fields =
        OptionFields<Source>("character")
            .add("body", &Source::body,
                 {.choices = bodies,
                  .meaning = "built in, or from a package: `pbskin fetch` brings some, and a message names that of a "
                             "missing one; empty: "
                             "from files"})
            .add("model", &Source::model_file,
                 {.meaning = "rigged model, relative to the scene: .glb .gltf .fbx .dae .zae; its surface is meshed, "
                             "and its joints are the "
                             "skeleton"})
            .add("scale", &Source::model_scale,
                 {.range = {1e-6, 1e6},
                  .meaning = "factor by which a model is enlarged, for files that state a wrong unit"})
            .add("mesh", &Source::mesh_file,
                 {.meaning = "tet mesh file, relative to the scene: .msh .vtu .vtk .mesh .ele"})
            .add("skeleton", &Source::skeleton_file,
                 {.meaning = "skeleton file, relative to the scene: .toml with [[joint]] tables, or the joints of a "
                             "clip or a rig "
                             "(.bvh .gltf .glb .fbx .dae .zae); with a model, only for one without joints: such a "
                             "file, or human, the skeleton "
                             "of that body"})
            .add("skeleton_scale", &Source::skeleton_scale,
                 {.unit = "m",
                  .range = {above_zero, 1e6},
                  .meaning = "metres per unit of the skeleton file; for CMU's clips 0.0254 / 0.45"})
            .add("vertices", &Source::vertices,
                 {.range = {0, 1e7},
                  .meaning = "wanted number of vertices of a named body or a model; 0: its own default"})
            .add("refine", &Source::refinements,
                 {.range = {0, 2},
                  .meaning = "number of times that every tet is cut into eight (8 or 64 times as many tets); the sizes "
                             "of the bones stay, "
                             "and the metrics are those of the finer mesh"});
    return fields;
}

const OptionFields<MotionSpec>& motion_fields()
{
    static const OptionFields<MotionSpec> fields =
        OptionFields<MotionSpec>("motion")
            .add("joint", &MotionSpec::joint, {.meaning = "the joint that a sweep turns"})
            .add("axis", &MotionSpec::axis, {.meaning = "axis of a sweep in rest world axes"})
            .add("angle_deg", &MotionSpec::angle_deg,
                 {.unit = "deg",
                  .range = {-7200, 7200},
                  .meaning = "angle of a sweep's last frame; frame i has angle_deg * i / (frames - 1)"})
            .add("frames", &MotionSpec::frames,
                 {.range = {2, 1e6},
                  .meaning = "number of frames of a sweep, including the rest pose; of each movement, after it"})
            .add("movements", &MotionSpec::movements,
                 {.meaning = "movements of joints through their range, one after the other, each from the rest pose; "
                             "A+B: both at once "
                             "(`pbskin list movements`)"})
            .add(
                "clip", &MotionSpec::clip,
                {.meaning =
                     "motion capture clip (.bvh .glb .gltf .fbx .dae .zae): relative to the scene, or by name from "
                     "Debian's "
                     "assimp-testmodels "
                     "(01_01.bvh); a bone follows the joint of the same name, or of the same part of the body in the "
                     "names of CMU (BVH, "
                     "ASF/AMC), Mixamo, Rigify, Unreal, VRM and VRoid, Rokoko, Poser and Daz, Biped, Character "
                     "Creator, OptiTrack, Xsens, "
                     "SMPL and Bandai-Namco; it may be z up or face another way, and its rest pose is its T or A pose"})
            .add("animation", &MotionSpec::animation,
                 {.meaning = "an animation of the clip's file, or without a clip of character.model, by name, the "
                             "second of equal names being "
                             "NAME (2); without this key the clip's first one that turns a joint by more than 5 "
                             "degrees, or without a joint and a "
                             "clip the model's first one"})
            .add("allow_partial", &MotionSpec::allow_partial,
                 {.meaning = "accepts a clip of which fewer than half of the moving joints match a bone, or one half "
                             "of a limb alone does; "
                             "fingers, "
                             "toes and the like aside where the names are known ones"})
            .add("start_s", &MotionSpec::start_s,
                 {.unit = "s",
                  .range = {0, 1e6},
                  .meaning = "start of the motion in the clip, after a T or A pose in its first frame"})
            .add("duration_s", &MotionSpec::duration_s,
                 {.unit = "s", .range = {0, 1e6}, .meaning = "duration of the motion; 0: to the end of the clip"})
            .add("rate_hz", &MotionSpec::rate_hz,
                 {.unit = "1/s",
                  .range = {1e-3, 1e5},
                  .meaning = "frames per second; a frame is a whole number of steps pbs.time_step_s"});
    return fields;
}

const OptionFields<OutputSpec>& output_fields()
{
    static const OptionFields<OutputSpec> fields =
        OptionFields<OutputSpec>("output")
            .add("frames_every", &OutputSpec::frames_every,
                 {.range = {0, 1e9}, .meaning = "write every n-th frame as VTU; 0: none"})
            .add("frames", &OutputSpec::frames, {.range = {0, 1e9}, .meaning = "further frames to write, by number"})
            .key("frame_names", texts, nlohmann::json::array(), {.meaning = "titles of `frames`, in the same order"})
            .add("glb", &OutputSpec::glb,
                 {.meaning = "also writes the surface of each deformer over the written frames as frames/LABEL.glb, "
                             "which Blender opens, "
                             "of a model with its normals, texture coordinates and materials; the character needs a "
                             "rendered surface"})
            .key("metrics", texts, {"all"},
                 {.meaning = "groups of metrics beyond the volume columns: errors, sections, surface, all; [] leaves "
                             "them out"});
    return fields;
}

SceneSchema scene_schema(const std::vector<DeformerKind>& kinds)
{
    SceneSchema schema;
    const auto append = [&](const std::vector<SceneKey>& keys) {
        schema.keys.insert(schema.keys.end(), keys.begin(), keys.end());
    };
    append(
        Keys("")
            .key("schema", integer, nullptr, {.range = {1, 1}, .is_stated = true, .meaning = "version of this format"})
            .keys());
    append(character_fields().keys());
    append(motion_fields().keys());
    append(Keys("pbs")
               .key("time_step_s", number, MotionSpec{}.time_step_s,
                    {.unit = "s",
                     .range = {1e-9, 1e3},
                     .meaning = "time step of Algorithm 1; by default the longest one of at most 10 ms that divides a "
                                "frame of a clip or an "
                                "animation"})
               .keys());
    append(
        Keys("skinning")
            .key("weights", text, "",
                 {.meaning =
                      "paper (Eq. 2), rigid (nearest bone), smooth (Eq. 2 with smooth transitions), diffused (Eq. 2 "
                      "smoothed over "
                      "the mesh's edges), either_end (Eq. 2 with n_joints at both ends of a bone), artist (of "
                      "character.model), "
                      "or a CSV file vertex,joint,weight; empty: artist for a model with joints, paper for all others"})
            .keys());
    for (const DeformerKind& kind : kinds) {
        append(kind.keys);
        schema.renamed.insert(schema.renamed.end(), kind.renamed_keys.begin(), kind.renamed_keys.end());
    }
    append(Keys("reference")
               .key("name", text, "", {.meaning = "the deformer that errors are measured against; empty: none"})
               .key("error_bar", text, name_of(ErrorBar::none),
                    {.choices = names_of_options<ErrorBar>(),
                     .meaning = "both also bounds the discretisation error of the reference, by three further "
                                "solutions: with the other element "
                                "order, on tets cut into eight, and both; the method is in run.json"})
               .key("seconds", number, 0.0,
                    {.unit = "s",
                     .range = {0.0, 1e7},
                     .meaning = "processor time for all frames of a quasi-static reference: it solves frames that are "
                                "evenly spread, ever "
                                "closer to each other, until the time is spent, and the others have no errors; 0: "
                                "every frame, whatever "
                                "it takes"})
               .keys());
    append(Keys("deformers")
               .key("use", texts, {"lbs", "pbs"},
                    {.meaning = "what moves the character: names of `pbskin list deformers` and of the tables [[fem]], "
                                "[[correctives]] and "
                                "[[external]]"})
               .keys());
    append(output_fields().keys());
    return schema;
}

}  // namespace experiments
