#include "experiments/trial/trial.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "experiments/scene/scene.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr double lowest_rate_hz = 1e-3,
                 highest_rate_hz = 30.0;  // of a scene; of a motion that is shorter than its frames
constexpr double lowest_scale = 1e-6, highest_scale = 1e6, shortest_motion_s = 1e-3;
constexpr double bend_deg = 60.0,
                 least_turn_deg = 5.0;  // of a model without a motion; of a joint in an animation that is worth a trial
constexpr double least_motion = 1e-3;   // rad, or over the size of the model: no one sees less
constexpr int frames_looked_at = 31;    // of each animation, to find the one that moves
// The last line of a trial's scene, with the hash of all lines before it: the scene was written by a trial and not
// changed since.
constexpr const char* seal = "# As `pbskin try` wrote it: ";

// A TOML string: JSON's escapes are TOML's, which escapes the character 127 too.
std::string quoted(const std::string& text)
{
    if (!analysis::is_utf8(text)) throw pbs::InputError(text, 0, "", "", "expected a name in UTF-8, as scenes are");
    std::string json = nlohmann::json(text).dump();
    for (std::size_t at = 0; (at = json.find('\x7f', at)) != std::string::npos;) json.replace(at, 1, "\\u007f");
    return json;
}

// As scene.toml names a file: relative to its folder.
std::string from_folder(const std::string& file, const std::string& folder)
{
    return fs::proximate(fs::absolute(file), fs::absolute(folder)).string();
}

std::string sampled(double duration_s, const TrialOptions& options, const std::string& file)
{
    return fmt::format("rate_hz = {}\n", nlohmann::json(trial_rate_hz(duration_s, options.frames, file)).dump());
}

// The clip that --animation names, if it is no animation of the model.
struct NamedClip {
    std::string given, file;     // as it was given; its path
    std::string animation = "";  // empty: the one that read_clip takes
};

// A clip of another skeleton is refused before any tets are made, which takes seconds.
std::string clip_motion(const TrialOptions& options, const NamedClip& named, const pbs::Skeleton& joints_of_the_model)
{
    const pbs::Clip clip = pbs::read_clip(named.file, named.animation);
    MotionSpec spec;
    spec.clip = named.file;
    spec.allow_partial = options.allow_partial;
    if (!joints_of_the_model.bones.empty()) accepted_match(spec, clip, joints_of_the_model);
    const std::string name = fs::exists(named.given) ? from_folder(named.file, options.folder) : named.given;
    return fmt::format("clip = {}\n", quoted(name)) +
           (named.animation.empty() ? "" : fmt::format("animation = {}\n", quoted(named.animation))) +
           (options.allow_partial ? "allow_partial = true\n" : "") +
           sampled((clip.frames() - 1 - pbs::first_frame_of_motion(clip)) * clip.frame_time_s, options, named.file);
}

// The bone with a parent that moves most of the skin together with all bones below it.
int bone_to_bend(const pbs::RiggedBody& body)
{
    std::vector<double> weight(body.skeleton.bones.size(), 0.0);
    for (std::size_t e = 0; e < body.skin.bone.size(); ++e) weight[body.skin.bone[e]] += body.skin.weight[e];
    int most = -1;
    for (int b = static_cast<int>(weight.size()) - 1; b >= 0; --b) {
        const int parent = body.skeleton.bones[b].parent;
        if (parent < 0) continue;
        weight[parent] += weight[b];
        if (most < 0 || weight[b] >= weight[most]) most = b;
    }
    return most;
}

std::string bending(const TrialOptions& options, const pbs::RiggedBody& body, bool has_animations,
                    std::vector<std::string>& notes)
{
    const int bone = bone_to_bend(body);
    if (bone < 0)
        throw pbs::InputError(
            options.model, 0, "animation", "",
            "the model has no animation that moves a joint, and no joint has a parent about which it could be bent: "
            "expected --animation CLIP");
    const pbs::Bone& bent = body.skeleton.bones[bone];
    const pbs::Vec3 axis = (bent.tail - bent.head).unitOrthogonal();
    notes.push_back(
        fmt::format("{}: it has no animation{}: the joint {} is bent by {} degrees (--animation CLIP takes a motion)",
                    options.model, has_animations ? " that moves a joint" : "", bent.name, bend_deg));
    return fmt::format("joint = {}\naxis = [{}, {}, {}]\nangle_deg = {:.1f}\nframes = {}\n", quoted(bent.name),
                       axis.x(), axis.y(), axis.z(), bend_deg, options.frames);
}

// FILE or FILE:NAME, either of which may have colons. Where there is no such file, the error lists the animations of
// the model.
NamedClip named_clip(const TrialOptions& options, const pbs::Rig& rig)
{
    const std::string& given = options.animation;
    for (std::size_t colon = given.size(); colon != std::string::npos && colon > 0;
         colon = given.rfind(':', colon - 1)) {
        NamedClip clip{.given = std::string(given, 0, colon), .file = ""};
        try {
            clip.file = pbs::find_clip(clip.given, "");
        } catch (const pbs::InputError&) {
            if (fs::exists(clip.given)) throw;
            continue;
        }
        if (colon + 1 == given.size())
            throw pbs::InputError("", 0, "--animation", given,
                                  "expected the name of an animation behind the colon, or the file alone");
        if (colon < given.size()) clip.animation = given.substr(colon + 1);
        return clip;
    }
    if (!rig.animations.empty()) pbs::find_animation(rig, given);  // whose error lists them
    throw pbs::InputError(options.model, 0, "animation", given,
                          "the file has no animation: expected a clip FILE, or FILE:NAME");
}

// The largest rotation of a bone against its parent from the first frame [deg]: the root's turns the whole body. A
// single bone counts itself.
double largest_turn_deg(pbs::Motion motion, const pbs::Skeleton& skeleton)
{
    for (pbs::Pose& pose : motion.steps)
        for (std::size_t b = pose.size(); b-- > 0;)  // parents come before their children
            if (const int parent = skeleton.bones[b].parent; parent >= 0)
                pose[b] = pose[static_cast<std::size_t>(parent)].inverse() * pose[b];
            else if (pose.size() > 1)
                pose[b].setIdentity();
    return pbs::largest_rotation_deg(motion);
}

// How an animation moves a model.
struct Movement {
    double turn_deg = 0.0;  // the largest one of a joint
    double size = 0.0;      // the larger of it [rad] and the largest displacement over the size of the model
    double pose_deg = 0.0;  // the largest turn of a joint from the file's rest pose in the first frame
};

Movement movement_of(const pbs::Rig& rig, const pbs::RiggedBody& body, const pbs::RigAnimation& animation)
{
    pbs::MotionSampling sampling;
    sampling.rate_hz = (frames_looked_at - 1) / std::max(animation.end_s - animation.start_s, shortest_motion_s);
    sampling.time_step_s = 1.0 / sampling.rate_hz;
    const pbs::Motion motion = pbs::rig_motion(rig, body, animation, sampling).motion;
    const double size_m = pbs::diagonal_m(body.surface);
    const double turn_deg = largest_turn_deg(motion, body.skeleton);
    const pbs::Pose at_rest = pbs::rig_motion(rig, body, {.name = "", .nodes = {}}, sampling).motion.steps.front();
    return {turn_deg, std::max(turn_deg * M_PI / 180.0, pbs::largest_displacement_m(motion, body.skeleton) / size_m),
            largest_turn_deg({.steps = {at_rest, motion.steps.front()}}, body.skeleton)};
}

}  // namespace

double trial_rate_hz(double duration_s, int frames, const std::string& file)
{
    const double rate_hz = duration_s > 0.0 ? std::min(highest_rate_hz, (frames - 1) / duration_s) : highest_rate_hz;
    if (rate_hz < lowest_rate_hz)
        throw pbs::InputError(file, 0, "duration of the motion [s]", pbs::number_text(duration_s),
                              fmt::format("expected at most {} for {} frames", (frames - 1) / lowest_rate_hz, frames));
    return rate_hz;
}

const pbs::RigAnimation* moving_animation(const TrialOptions& options, const pbs::Rig& rig, const pbs::RiggedBody& body,
                                          TrialScene& made)
{
    const auto& animations = rig.animations;
    std::vector<Movement> motions;
    made.animations = nlohmann::json::array();
    for (const pbs::RigAnimation& animation : animations) {
        motions.push_back(movement_of(rig, body, animation));
        made.animations.push_back({{"name", animation.name},
                                   {"duration_s", animation.end_s - animation.start_s},
                                   {"largest_rotation_deg", motions.back().turn_deg}});
    }
    if (animations.empty()) return nullptr;
    auto moving =
        std::ranges::find_if(motions, [](const Movement& motion) { return motion.turn_deg > least_turn_deg; });
    std::string why = fmt::format("the first one that turns a joint by more than {} degrees", least_turn_deg);
    if (moving == motions.end()) {
        moving = std::ranges::max_element(motions, {}, &Movement::size);
        why = fmt::format("which moves most: none turns a joint by more than {} degrees", least_turn_deg);
    }
    if (moving->size <= least_motion) {  // takes without keys, poses, and those that move morph targets alone
        moving = std::ranges::max_element(motions, {}, &Movement::pose_deg);
        why = "a pose: none moves a joint";
        const bool is_pose = moving->pose_deg > least_turn_deg;
        if (!is_pose && (bone_to_bend(body) >= 0 || !moves_nodes(animations[moving - motions.begin()]))) return nullptr;
    }
    const pbs::RigAnimation& taken = animations[moving - motions.begin()];
    std::vector<std::string> others;
    for (const pbs::RigAnimation& animation : animations)
        if (&animation != &taken) others.push_back(animation.name);
    if (!others.empty() && options.animation.empty())
        made.remarks.notes.push_back(
            fmt::format("{}: it has {} animations; {} is taken, {} (--animation NAME takes another one: {})",
                        options.model, animations.size(), taken.name, why, fmt::join(others, ", ")));
    return &taken;
}

namespace {

std::string motion(const TrialOptions& options, TrialScene& made)
{
    const pbs::Rig rig = pbs::read_rig(options.model);
    const pbs::RiggedBody body = pbs::make_rigged_body(rig, nullptr, options.scale);
    const pbs::RigAnimation* taken = moving_animation(options, rig, body, made);
    const auto named = std::ranges::find(rig.animations, options.animation, &pbs::RigAnimation::name);
    if (named != rig.animations.end())
        taken = &*named;
    else if (!options.animation.empty())
        return clip_motion(options, named_clip(options, rig), body.skeleton);
    const auto moves_morphs = [](const pbs::NodeTracks& tracks) { return !tracks.morph_weights.empty(); };
    if (taken && std::ranges::any_of(taken->nodes, moves_morphs))
        made.remarks.notes.push_back(
            fmt::format("{}: animation {} also moves morph targets: the artist's surface follows them, and the flesh "
                        "keeps their weights at rest",
                        options.model, taken->name));
    if (taken)
        return fmt::format("animation = {}\n", quoted(taken->name)) +
               sampled(taken->end_s - taken->start_s, options, options.model);
    if (body.skeleton.bones.empty())
        throw pbs::InputError(
            options.model, 0, "skins", "0",
            "the model has no joints and no animation: expected --skeleton FILE and --animation CLIP");
    return bending(options, body, !rig.animations.empty(), made.remarks.notes);
}

// The settings of the built-in scenes, except for delta mush: a model may be thinner than their bodies.
constexpr const char* pbs_table = R"([delta_mush]
unsmoothed_share = 0.01          # limbs that are a few tets thick are not turned inside out
[pbs]
iterations = 24
k_stretch = 0.2
k_volume = 1.0
k_bind = 1.0
gravity_m_s2 = [0.0, 0.0, 0.0]   # a model does not state which way is up
)";

constexpr const char* reference_tables = R"([[fem]]
name = "nh_p1"                   # the reference: a neo-Hookean body on the same tets
model = "neo_hookean"
element_order = 1
attachment = "held"              # what one bone alone moves, such as a head, follows it
[reference]
name = "nh_p1"
)";

// False in a build or an installation without them.
bool finds_the_finite_elements(const TrialOptions& options, std::vector<std::string>& remarks)
{
    try {
        load_module_with_blas("pbskin_fem");
        return true;
    } catch (const pbs::InputError& error) {
        remarks.push_back(fmt::format("{}: the trial has no reference: {}", options.model, error.what()));
        return false;
    }
}

}  // namespace

TrialScene trial_scene(const TrialOptions& options)
{
    if (options.frames < 2)
        throw pbs::InputError("", 0, "--frames", std::to_string(options.frames), "expected at least 2");
    if (!(options.scale >= lowest_scale && options.scale <= highest_scale))
        throw pbs::InputError("", 0, "--scale", fmt::format("{}", options.scale), "expected a number from 1e-6 to 1e6");
    const bool has_skeleton_file = !options.skeleton.empty() && options.skeleton != "human";
    if (has_skeleton_file && !fs::exists(options.skeleton))
        throw pbs::InputError(options.skeleton, 0, "", "", "no such file");
    TrialScene made;
    const std::string moved = motion(options, made);
    const bool reference = options.reference && finds_the_finite_elements(options, made.remarks.warnings);
    if (options.bake && !reference)
        throw pbs::InputError(options.model, 0, "--bake", "",
                              "expected the finite elements, from which correctives are learned");
    std::string character = fmt::format("model = {}\n", quoted(from_folder(options.model, options.folder)));
    if (options.scale != 1.0) character += fmt::format("scale = {}\n", nlohmann::json(options.scale).dump());
    if (options.vertices > 0) character += fmt::format("vertices = {}\n", options.vertices);
    if (!options.skeleton.empty())
        character += fmt::format("skeleton = {}\n",
                                 quoted(has_skeleton_file ? from_folder(options.skeleton, options.folder) : "human"));
    const bool has_artist = options.skeleton.empty();
    made.text = fmt::format(
        "# {} through its motion. Change this file and run it: pbskin run {} -o DIR\nschema = "
        "1\n[character]\n{}[motion]\n{}",
        quoted(options.model), quoted((fs::path(options.folder) / "scene.toml").string()), character, moved);
    made.text += pbs_table;
    if (has_artist)
        made.text +=
            "[[lbs]]\nname = \"lbs_paper\"               # linear blend skinning with the weights of Eq. 2\nweights = "
            "\"paper\"\n";
    if (reference) {
        made.text += reference_tables;
        if (options.error_bar)
            made.text += "error_bar = \"both\"\n";
        else if (options.reference_seconds > 0.0)
            made.text += fmt::format("seconds = {}   # of processor time, spent on evenly spread frames\n",
                                     nlohmann::json(options.reference_seconds).dump());
    }
    made.text += fmt::format("[deformers]\nuse = [\"lbs\", \"dqs\", {}\"delta_mush\", \"pbs\"{}]\n",
                             has_artist ? "\"lbs_paper\", " : "", reference ? ", \"nh_p1\"" : "");
    made.text +=
        "[output]\nframes_every = 1\nglb = true                       # also the moving surface of each deformer\n";
    made.text += seal + pbs::content_hash(made.text) + "\n";
    return made;
}

std::string earlier_trial_scene(const TrialOptions& options)
{
    const fs::path folder(options.folder), scene_file = folder / "scene.toml";
    const std::string expected = "expected another folder (-o) for " + options.model;
    if (!fs::exists(scene_file)) {
        for (const char* name : {"run.json", "metrics.csv", "try.json", "report.html", "frames", "skin"})
            if (fs::exists(folder / name))
                throw pbs::InputError((folder / name).string(), 0, "", "",
                                      "exists, and the folder is not that of a trial: " + expected);
        return "";
    }
    const std::string text = pbs::read_text_file(scene_file.string(), pbs::most_text_bytes);
    const std::size_t end = std::min(text.rfind(seal), text.size());
    if (text.substr(end) != seal + pbs::content_hash(text.substr(0, end)) + "\n")
        throw pbs::InputError(
            scene_file.string(), 0, "", "",
            "exists and is not the scene of a trial, or was changed: " + expected + "; `pbskin run` runs this scene");
    const std::string model = SceneValues(text, scene_file.string(), {}, scene_schema()).text("character.model");
    if (fs::weakly_canonical(folder / model) != fs::weakly_canonical(options.model))
        throw pbs::InputError(scene_file.string(), 0, "character.model", model,
                              "the folder has the trial of this model: " + expected);
    return text;
}

}  // namespace experiments
