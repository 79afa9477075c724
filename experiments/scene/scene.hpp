// A scene: a character, its motion, the deformers and the output. It is read from TOML. `pbskin explain KEY` and manual.md explain the
// keys.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/settings/scene_values.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/clip.hpp"
#include "pbs/skinning/pose.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace experiments {

struct DeformerKind;
template <typename Options>
class OptionFields;

struct MotionSpec {
    std::string joint;                    // a sweep of this joint
    pbs::Vec3 axis = pbs::Vec3::UnitX();  // in rest world axes, of any length
    double angle_deg = 0.0;               // of the last frame
    std::vector<std::string> movements;   // or movements of scenes/movements.toml; A+B: both at once
    int frames = 18;                      // of a sweep; of each movement, after the rest pose
    std::string clip;                     // or a clip: its path
    bool of_model = false;                // or an animation of the character's model, which may have none
    std::string animation;                // its name, or of the clip's file; empty: the first one, of a clip the first that moves
    bool allow_partial = false;           // of a clip: fewer than half of its moving joints may match
    double start_s = 0.0, duration_s = 0.0, rate_hz = 100.0;
    double time_step_s = 0.01;
};

struct OutputSpec {
    int frames_every = 1;                                 // every n-th frame is written; 0: only `frames`
    std::vector<int> frames;                              // further frames, by number
    bool errors = true, sections = true, surface = true;  // groups of metrics
    bool glb = false;                                     // the surface of each deformer in the written frames, as one .glb file
    bool surface_files = true;                            // and as a .vtp file per frame; no key of a scene
    double most_glb_bytes = std::numeric_limits<double>::infinity();   // of all .glb files together, which then have fewer frames; no key
    double most_skin_bytes = std::numeric_limits<double>::infinity();  // of the files of the artist's surface; no key

    bool writes(int frame) const;
};

// The further solutions that bound the distance of the reference from the limit of ever finer tets: none, or both element orders on its
// tets and on tets that are refined once.
enum class ErrorBar { none, both };

NAMED_OPTIONS(ErrorBar, none, both)

struct Scene {
    std::string name, file;
    pbs::CharacterSource character;
    MotionSpec motion;
    std::vector<DeformerSpec> deformers;
    std::string reference;  // name of the deformer that errors are measured against; empty: none
    ErrorBar error_bar = ErrorBar::none;
    double reference_seconds = 0.0;  // of processor time, for all of its frames; 0: no limit
    OutputSpec output;
    nlohmann::json resolved;  // every key and value, for run.json; paths as in the scene
};

// The first deformer with options of this type; null: there is none.
template <typename Options>
const DeformerSpec* find_deformer_with(const Scene& scene)
{
    for (const DeformerSpec& spec : scene.deformers)
        if (options_if<Options>(spec)) return &spec;
    return nullptr;
}

// Reads a scene file, or a built-in scene by name (`pbskin list scenes`).
Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides);

// The deformers of all [[kind]] tables, including those that the scene does not use. InputError for a name that is no identifier, is used
// twice or is that of a kind.
std::vector<DeformerSpec> listed_deformers(const SceneValues& values);

// `resolved` and the options of every deformer, including those that only studies set: all that the result of a run depends on.
nlohmann::json to_json(const Scene& scene);

struct BuiltInScene {
    std::string name, text, meaning;
};
const std::vector<BuiltInScene>& built_in_scenes();

// The motion that a scene asks for.

// A sweep, movements or a clip on a skeleton. `scene_file` is named in errors.
pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);

// Messages for the user; each is one sentence.
struct Remarks {
    std::vector<std::string> warnings, notes;  // a result is doubtful; nothing is wrong
};

// The rest pose, and from it through each movement at an even rate: frame k spec.frames + i has i / spec.frames of movement k. Between two
// movements the body is back at rest within one step. InputErrors: an unknown movement, a joint that the skeleton lacks, and a straight
// limb where its bend at rest is the axis.
pbs::Motion through_movements(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);
std::vector<std::string> movements_of(const pbs::Skeleton& skeleton);  // those whose joints it has, pairs last
std::vector<std::pair<std::string, std::string>> listed_movements();   // name and meaning
std::vector<std::string> joints_of(const std::string& movement);
bool is_twist(const std::string& movement);  // about the bones' own axes alone

// Any motion, with what looks wrong about it, a sentence each: a motion in which no bone turns, bones that the animation scales,
// joints that move apart, joints and bones that a clip leaves out. An InputError where accepted_match throws one.
struct StretchedBone {
    std::string bone;
    double change_pct = 0.0;  // of its distance from its parent, where it changes most
    int frame = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StretchedBone, bone, change_pct, frame)

struct CaseMotion {
    pbs::Motion motion;
    pbs::RemarkList remarks;
    std::vector<std::string> notes;             // what the reader of a clip chose, and parts that point elsewhere by more than 10 degrees
    std::vector<pbs::PartAngle> angles = {};    // between the body and a clip
    std::vector<StretchedBone> stretched = {};  // by more than 10 %, the most stretched first: squash and stretch
    int clip_joints = 0, matched_joints = 0;    // of a clip: its joints that move, and those of them that move a bone
    double largest_rotation_deg = 0.0;          // of a bone, from the first frame to another one
    bool is_far_from_clip() const               // some part of the body points elsewhere by more than 30 degrees
    {
        return std::ranges::any_of(angles, [](const pbs::PartAngle& angle) { return angle.largest_deg > 30.0; });
    }
    std::string time_zero;     // what time_s = 0 of the records is
    double time_zero_s = 0.0;  // that time in the file of the clip or the animation; 0 of a sweep
};
CaseMotion make_case_motion(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file);

// The moving joints of a clip that move a bone of the skeleton. An InputError if there are none, or if the scene does not allow it and they
// are fewer than one half or leave out a half of a limb. Fingers, toes and the like of a clip whose scheme of names is known do not count
// where the skeleton lacks them.
pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton);

pbs::MotionSampling sampling_of(const MotionSpec& spec);

// All keys of a scene, those of the deformers among them: of these kinds, or of all that are registered.
SceneSchema scene_schema(const std::vector<DeformerKind>& kinds);
SceneSchema scene_schema();

// The keys that are members of these structs.
const OptionFields<pbs::CharacterSource>& character_fields();
const OptionFields<MotionSpec>& motion_fields();
const OptionFields<OutputSpec>& output_fields();

}  // namespace experiments
