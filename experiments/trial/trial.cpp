#include "experiments/trial/trial.hpp"

#include "analysis/metrics/skin_error.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/process/terminal.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/character/clip.hpp"
#include "pbs/character/json_file.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/rig_reader.hpp"
#include "pbs/rig/rigged_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr double lowest_rate_hz = 1e-3, highest_rate_hz = 30.0;  // of a scene; of a motion that is shorter than its frames
constexpr double lowest_scale = 1e-6, highest_scale = 1e6, shortest_motion_s = 1e-3;
constexpr double bend_deg = 60.0, least_turn_deg = 5.0;  // of a model without a motion; of a joint in an animation that is worth a trial
constexpr int frames_looked_at = 31;                     // of each animation, to find the one that moves
// The last line of a trial's scene, with the hash of all lines before it: the scene was written by a trial and not changed since.
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
           sampled((clip.frames() - 2) * clip.frame_time_s, options, named.file);  // the first frame is a T pose
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

std::string bending(const TrialOptions& options, const pbs::RiggedBody& body, std::vector<std::string>& notes)
{
    const int bone = bone_to_bend(body);
    if (bone < 0)
        throw pbs::InputError(options.model, 0, "animation", "",
                              "the model has no animation, and no joint has a parent about which it could be bent: "
                              "expected --animation CLIP");
    const pbs::Bone& bent = body.skeleton.bones[bone];
    const pbs::Vec3 axis = (bent.tail - bent.head).unitOrthogonal();
    notes.push_back(fmt::format("{}: it has no animation: the joint {} is bent by {} degrees (--animation CLIP takes a motion)",
                                options.model, bent.name, bend_deg));
    return fmt::format("joint = {}\naxis = [{}, {}, {}]\nangle_deg = {:.1f}\nframes = {}\n", quoted(bent.name), axis.x(), axis.y(),
                       axis.z(), bend_deg, options.frames);
}

// FILE or FILE:NAME, either of which may have colons. Where there is no such file, the error lists the animations of the model.
NamedClip named_clip(const TrialOptions& options, const pbs::Rig& rig)
{
    const std::string& given = options.animation;
    for (std::size_t colon = given.size(); colon != std::string::npos && colon > 0; colon = given.rfind(':', colon - 1)) {
        NamedClip clip{.given = std::string(given, 0, colon), .file = ""};
        try {
            clip.file = pbs::find_clip(clip.given, "");
        } catch (const pbs::InputError&) {
            if (fs::exists(clip.given)) throw;
            continue;
        }
        if (colon + 1 < given.size()) clip.animation = given.substr(colon + 1);
        return clip;
    }
    if (!rig.animations.empty()) pbs::find_animation(rig, given);  // whose error lists them
    throw pbs::InputError(options.model, 0, "animation", given, "the file has no animation: expected a clip FILE, or FILE:NAME");
}

// The largest rotation of a bone against its parent from the first frame [deg]: the root's turns the whole body. A single bone counts
// itself.
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

// The largest turn of a joint [deg], and the larger of it [rad] and the largest displacement over the size of the model.
std::pair<double, double> motion_of(const pbs::Rig& rig, const pbs::RiggedBody& body, const pbs::RigAnimation& animation)
{
    pbs::MotionSampling sampling;
    sampling.rate_hz = (frames_looked_at - 1) / std::max(animation.end_s - animation.start_s, shortest_motion_s);
    sampling.time_step_s = 1.0 / sampling.rate_hz;
    const pbs::Motion motion = pbs::rig_motion(rig, body, animation, sampling).motion;
    const double size_m = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).norm();
    const double turn_deg = largest_turn_deg(motion, body.skeleton);
    return {turn_deg, std::max(turn_deg * M_PI / 180.0, pbs::largest_displacement_m(motion, body.skeleton) / size_m)};
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

const pbs::RigAnimation* moving_animation(const TrialOptions& options, const pbs::Rig& rig, const pbs::RiggedBody& body, TrialScene& made)
{
    const auto& animations = rig.animations;
    std::vector<std::pair<double, double>> motions;
    made.animations = nlohmann::json::array();
    for (const pbs::RigAnimation& animation : animations) {
        motions.push_back(motion_of(rig, body, animation));
        made.animations.push_back({{"name", animation.name},
                                   {"duration_s", animation.end_s - animation.start_s},
                                   {"largest_rotation_deg", motions.back().first}});
    }
    if (animations.empty()) return nullptr;
    auto moving = std::ranges::find_if(motions, [](const auto& motion) { return motion.first > least_turn_deg; });
    std::string why = fmt::format("the first one that turns a joint by more than {} degrees", least_turn_deg);
    if (moving == motions.end()) {
        moving = std::ranges::max_element(motions, {}, &std::pair<double, double>::second);
        why = fmt::format("which moves most: none turns a joint by more than {} degrees", least_turn_deg);
    }
    const pbs::RigAnimation& taken = animations[moving - motions.begin()];
    std::vector<std::string> others;
    for (const pbs::RigAnimation& animation : animations)
        if (&animation != &taken) others.push_back(animation.name);
    if (!others.empty() && options.animation.empty())
        made.remarks.notes.push_back(fmt::format("{}: it has {} animations; {} is taken, {} (--animation NAME takes another one: {})",
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
    if (taken) return fmt::format("animation = {}\n", quoted(taken->name)) + sampled(taken->end_s - taken->start_s, options, options.model);
    if (body.skeleton.bones.empty())
        throw pbs::InputError(options.model, 0, "skins", "0",
                              "the model has no joints and no animation: expected --skeleton FILE and --animation CLIP");
    return bending(options, body, made.remarks.notes);
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

constexpr const char* reference_name = "nh_p1";
constexpr const char* reference_tables = R"([[fem]]
name = "nh_p1"                   # the reference: a neo-Hookean body on the same tets
model = "neo_hookean"
element_order = 1
attachment = "held"              # what one bone alone moves, such as a head, follows it
[reference]
name = "nh_p1"
)";

constexpr double least_visible_pct = 0.01;  // changes of volume and errors below it are no difference between two methods

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

using analysis::CsvTable;

// The number of a cell; nothing for an empty cell and for one that is not finite, as of a frame that broke down.
std::optional<double> finite(const CsvTable& table, int row, const std::string& column)
{
    const auto value = table.number_or_nothing(row, column);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

nlohmann::json volume_facts(const CsvTable& metrics)
{
    nlohmann::json facts;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto change_pct = finite(metrics, row, "volume_change_pct");
        if (!change_pct) continue;
        const auto inverted = metrics.integer(row, "inverted_tets");
        nlohmann::json& of = facts[metrics.text_at(row, "deformer")];
        if (of.is_null()) of = {{"lowest_pct", *change_pct}, {"highest_pct", *change_pct}, {"most_inverted_tets", inverted}};
        of["lowest_pct"] = std::min(of["lowest_pct"].get<double>(), *change_pct);
        of["highest_pct"] = std::max(of["highest_pct"].get<double>(), *change_pct);
        of["most_inverted_tets"] = std::max(of["most_inverted_tets"].get<long long>(), inverted);
    }
    return facts;
}

nlohmann::json frame_ms(const CsvTable& metrics)
{
    std::map<std::string, std::vector<double>> times;
    for (int row = 0; row < metrics.rows(); ++row) times[metrics.text_at(row, "deformer")].push_back(metrics.number(row, "step_ms"));
    nlohmann::json facts;
    for (const auto& [deformer, ms] : times) facts[deformer] = analysis::median(ms);
    return facts;
}

// Over the frames whose bound is known; null without an error bar.
nlohmann::json error_bar_facts(const CsvTable& metrics, const pbs::JsonFile& run)
{
    constexpr const char* bound = "reference_error_joint_pct";
    if (!metrics.has_column(bound)) return nullptr;
    std::vector<double> bounds_pct;
    int frames = 0;
    for (int row = 0; row < metrics.rows(); ++row) {
        if (metrics.text_at(row, "deformer") != reference_name) continue;
        ++frames;
        if (const auto bound_pct = finite(metrics, row, bound)) bounds_pct.push_back(*bound_pct);
    }
    const nlohmann::json& seconds = run.at(run.at("cost"), "seconds");
    const double total_s = seconds.value("error_bar", 0.0) + seconds.value("error_bar_set_up", 0.0);
    nlohmann::json facts = {{"frames", bounds_pct.size()}, {"of", frames}, {"seconds", total_s}, {"largest_pct", nullptr}};
    if (!bounds_pct.empty()) facts["largest_pct"] = std::ranges::max(bounds_pct);
    return facts;
}

// Whether some flesh changes its shape: a rigid motion leaves every tet its volume.
bool deforms(const CsvTable& metrics)
{
    if (!metrics.has_column("volume_abs_change_pct")) return true;
    for (int row = 0; row < metrics.rows(); ++row)
        if (finite(metrics, row, "volume_abs_change_pct").value_or(least_visible_pct) >= least_visible_pct) return true;
    return false;
}

// By frame and deformer, in frames in which somebody has a visible error.
using FrameErrors = std::map<long long, std::map<std::string, double>>;

FrameErrors errors_of(const CsvTable& metrics, const std::string& column)
{
    FrameErrors errors;
    if (!metrics.has_column(column)) return errors;
    for (int row = 0; row < metrics.rows(); ++row)
        if (const auto error = finite(metrics, row, column))
            if (const std::string& of = metrics.text_at(row, "deformer"); of != reference_name)
                errors[metrics.integer(row, "frame")][of] = *error;
    std::erase_if(errors, [](const auto& frame) {
        return std::ranges::all_of(frame.second, [](const auto& of) { return of.second < least_visible_pct; });
    });
    return errors;
}

// Methods with more inverted tets than lbs has in the same frame: the number of such frames, and the most inverted tets in one of them.
nlohmann::json inverting_methods(const CsvTable& metrics)
{
    std::map<long long, long long> of_lbs;
    for (int row = 0; row < metrics.rows(); ++row)
        if (metrics.text_at(row, "deformer") == "lbs") of_lbs[metrics.integer(row, "frame")] = metrics.integer(row, "inverted_tets");
    nlohmann::json methods = nlohmann::json::object();
    for (int row = 0; row < metrics.rows(); ++row) {
        const std::string& name = metrics.text_at(row, "deformer");
        const auto lbs = of_lbs.find(metrics.integer(row, "frame"));
        const auto inverted = metrics.integer(row, "inverted_tets");
        if (name == reference_name || lbs == of_lbs.end() || inverted <= lbs->second) continue;
        nlohmann::json& method = methods[name];
        if (method.is_null()) method = {{"frames", 0}, {"most_inverted_tets", 0}};
        method["frames"] = method["frames"].get<int>() + 1;
        method["most_inverted_tets"] = std::max(method["most_inverted_tets"].get<long long>(), inverted);
    }
    return methods;
}

// Frames in which both have an error, and those of them in which that of pbs is smaller; null without such frames.
nlohmann::json nearer_than(const std::string& other, const FrameErrors& errors)
{
    int compared = 0, nearer = 0;
    for (const auto& [frame, of] : errors) {
        if (of.count(other) == 0 || of.count("pbs") == 0) continue;
        ++compared;
        nearer += of.at("pbs") < of.at(other);
    }
    if (compared == 0) return nullptr;
    return {{"deformer", other}, {"frames", nearer}, {"of", compared}};
}

// pbs against lbs, and against the one of the others whose median error is smallest. A method that turns tets inside out is not compared.
nlohmann::json nearer_frames(const FrameErrors& errors, const nlohmann::json& inverting)
{
    if (inverting.contains("pbs")) return nullptr;
    nlohmann::json nearer = nearer_than("lbs", errors);
    if (nearer.is_null()) return nullptr;
    // A method that fails in the hard frames would look best by the others: only frames in which all have an error count.
    const auto most = std::ranges::max_element(errors, {}, [](const auto& frame) { return frame.second.size(); });
    std::map<std::string, std::vector<double>> others;
    for (const auto& [frame, of] : errors)
        for (const auto& [deformer, error] : of)
            if (of.size() == most->second.size() && deformer != "pbs" && deformer != "lbs" && !inverting.contains(deformer))
                others[deformer].push_back(error);
    const auto best = std::ranges::min_element(others, {}, [](const auto& other) { return analysis::median(other.second); });
    nearer["best_other"] = best == others.end() ? nlohmann::json() : nearer_than(best->first, errors);
    return nearer;
}

// At the joints, or over the body where no frame has an error there, and over the skin.
nlohmann::json nearer_facts(const CsvTable& metrics, const nlohmann::json& inverting)
{
    const FrameErrors at_joints = errors_of(metrics, "error_joint_pct");
    return {{at_joints.empty() ? "body" : "joints",
             nearer_frames(at_joints.empty() ? errors_of(metrics, "error_l2_pct") : at_joints, inverting)},
            {"skin", nearer_frames(errors_of(metrics, "skin_rms_pct"), inverting)}};
}

// The skin's distance from the reference under lbs and pbs, rms over the frames in which both have one.
nlohmann::json skin_facts(const CsvTable& metrics)
{
    if (!metrics.has_column("skin_rms_mm")) return nullptr;
    struct Distances {
        double mm = 0.0, pct = 0.0;
    };
    std::map<long long, std::map<std::string, Distances>> frames;
    for (int row = 0; row < metrics.rows(); ++row) {
        const auto mm = finite(metrics, row, "skin_rms_mm"), pct = finite(metrics, row, "skin_rms_pct");
        if (mm && pct) frames[metrics.integer(row, "frame")][metrics.text_at(row, "deformer")] = {*mm, *pct};
    }
    std::erase_if(frames, [](const auto& frame) { return frame.second.count("lbs") == 0 || frame.second.count("pbs") == 0; });
    const auto rms = [&](const char* deformer, double Distances::*distance) {
        double squares = 0.0;
        for (const auto& [frame, of] : frames) squares += of.at(deformer).*distance * (of.at(deformer).*distance);
        return std::sqrt(squares / static_cast<double>(frames.size()));
    };
    if (frames.empty() || rms("lbs", &Distances::pct) < least_visible_pct) return nullptr;
    const double lbs_mm = rms("lbs", &Distances::mm), pbs_mm = rms("pbs", &Distances::mm);
    return {{"lbs_mm", lbs_mm}, {"pbs_mm", pbs_mm}, {"removed_pct", analysis::removed_share_pct(lbs_mm, pbs_mm)}};
}

// The frame in which the surfaces of pbs and lbs are farthest apart (rms); null where they never differ.
nlohmann::json widest_frame(const CsvTable& distances)
{
    double widest_mm = 0.0;
    nlohmann::json frame;
    for (int row = 0; row < distances.rows(); ++row)
        if (const double mm = finite(distances, row, "rms_mm").value_or(0.0);
            mm > widest_mm && distances.text_at(row, "deformer") == "pbs" && distances.text_at(row, "other") == "lbs")
            widest_mm = mm, frame = distances.integer(row, "frame");
    return frame;
}

struct JointChange {
    std::string name;
    double share_pct = 0.0;                    // of the body's volume
    std::map<std::string, double> change_pct;  // of the body's volume, by deformer
};

// The two joints, of a bone and its parent, at which lbs loses most of the body's volume.
nlohmann::json joint_facts(const CsvTable& regions, const CsvTable& bones)
{
    std::map<std::string, std::string> parent;
    for (int row = 0; row < bones.rows(); ++row) parent[bones.text_at(row, "bone")] = bones.text_at(row, "parent");
    std::map<std::string, JointChange> joints;
    for (int row = 0; row < regions.rows(); ++row) {
        if (regions.text_at(row, "kind") != "joint") continue;
        const std::string &one = regions.text_at(row, "bone"), &other = regions.text_at(row, "second_bone");
        if (parent[other] != one && parent[one] != other) continue;  // their flesh meets, but no joint connects them
        const std::string name = one + " - " + other;
        JointChange& joint = joints[name];
        joint.name = name;
        joint.share_pct = regions.number(row, "rest_share_pct");
        joint.change_pct[regions.text_at(row, "deformer")] = regions.number(row, "change_pct");
    }
    std::vector<JointChange> sorted;
    for (const auto& [name, joint] : joints)
        if (joint.change_pct.count("lbs") > 0 && joint.change_pct.count("pbs") > 0) sorted.push_back(joint);
    std::ranges::sort(sorted, {}, [](const JointChange& joint) { return joint.change_pct.at("lbs"); });
    sorted.resize(std::min<std::size_t>(sorted.size(), 2));
    if (sorted.empty()) return nullptr;
    nlohmann::json facts = {{"names", nlohmann::json::array()}};
    double share_pct = 0.0, lbs_pct = 0.0, pbs_pct = 0.0;
    for (const JointChange& joint : sorted) {
        facts["names"].push_back(joint.name);
        share_pct += joint.share_pct;
        lbs_pct += joint.change_pct.at("lbs");
        pbs_pct += joint.change_pct.at("pbs");
    }
    if (!(share_pct > 0.0)) return nullptr;
    facts["lbs_pct"] = 100.0 * lbs_pct / share_pct;
    facts["pbs_pct"] = 100.0 * pbs_pct / share_pct;
    return facts;
}

}  // namespace

TrialScene trial_scene(const TrialOptions& options)
{
    if (options.frames < 2) throw pbs::InputError("", 0, "--frames", std::to_string(options.frames), "expected at least 2");
    if (!(options.scale >= lowest_scale && options.scale <= highest_scale))
        throw pbs::InputError("", 0, "--scale", fmt::format("{}", options.scale), "expected a number from 1e-6 to 1e6");
    const bool has_skeleton_file = !options.skeleton.empty() && options.skeleton != "human";
    if (has_skeleton_file && !fs::exists(options.skeleton)) throw pbs::InputError(options.skeleton, 0, "", "", "no such file");
    TrialScene made;
    const std::string moved = motion(options, made);
    const bool reference = options.reference && finds_the_finite_elements(options, made.remarks.warnings);
    std::string character = fmt::format("model = {}\n", quoted(from_folder(options.model, options.folder)));
    if (options.scale != 1.0) character += fmt::format("scale = {}\n", nlohmann::json(options.scale).dump());
    if (options.vertices > 0) character += fmt::format("vertices = {}\n", options.vertices);
    if (!options.skeleton.empty())
        character += fmt::format("skeleton = {}\n", quoted(has_skeleton_file ? from_folder(options.skeleton, options.folder) : "human"));
    const bool has_artist = options.skeleton.empty();
    made.text =
        fmt::format("# {} through its motion. Change this file and run it: pbskin run {} -o DIR\nschema = 1\n[character]\n{}[motion]\n{}",
                    quoted(options.model), quoted((fs::path(options.folder) / "scene.toml").string()), character, moved);
    made.text += pbs_table;
    if (has_artist)
        made.text += "[[lbs]]\nname = \"lbs_paper\"               # linear blend skinning with the weights of Eq. 2\nweights = \"paper\"\n";
    if (reference) {
        made.text += reference_tables;
        if (options.error_bar)
            made.text += "error_bar = \"both\"\n";
        else if (options.reference_seconds > 0.0)
            made.text += fmt::format("seconds = {}   # of processor time, spent on evenly spread frames\n",
                                     nlohmann::json(options.reference_seconds).dump());
    }
    made.text += fmt::format("[deformers]\nuse = [\"lbs\", \"dqs\", {}\"delta_mush\", \"pbs\"{}]\n", has_artist ? "\"lbs_paper\", " : "",
                             reference ? ", \"nh_p1\"" : "");
    made.text += "[output]\nframes_every = 1\nglb = true                       # also the moving surface of each deformer\n";
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
                throw pbs::InputError((folder / name).string(), 0, "", "", "exists, and the folder is not that of a trial: " + expected);
        return "";
    }
    const std::string found = pbs::read_text_file(scene_file.string(), pbs::most_text_bytes);
    const std::size_t end = std::min(found.rfind(seal), found.size());
    if (found.substr(end) != seal + pbs::content_hash(found.substr(0, end)) + "\n")
        throw pbs::InputError(scene_file.string(), 0, "", "",
                              "exists and is not the scene of a trial, or was changed: " + expected + "; `pbskin run` runs this scene");
    const std::string model = SceneValues(found, scene_file.string(), {}, scene_schema()).text("character.model");
    if (fs::weakly_canonical(folder / model) != fs::weakly_canonical(options.model))
        throw pbs::InputError(scene_file.string(), 0, "character.model", model, "the folder has the trial of this model: " + expected);
    return found;
}

nlohmann::json trial_facts(const std::string& folder)
{
    const pbs::JsonFile run(folder + "/run.json");
    const CsvTable metrics = analysis::read_csv(folder + "/metrics.csv"), regions = analysis::read_csv(folder + "/regions.csv"),
                   bones = analysis::read_csv(folder + "/bones_rest.csv");
    const std::string distances = folder + "/distances.csv";
    const nlohmann::json inverting = inverting_methods(metrics);
    const nlohmann::json &outcome = run.at("outcome"), &character = run.at("character");
    return {{"schema", 1},
            {"model", run.at(character, "model")},
            {"tets", run.at(character, "tets")},
            {"vertices", run.at(character, "vertices")},
            {"motion", run.at(outcome, "motion")},
            {"frames", run.at(outcome, "frames")},
            {"warnings", run.at(outcome, "warnings")},
            {"from_artist", outcome.value("from_artist", nlohmann::json())},
            {"notes", run.at(outcome, "notes")},
            {"deforms", deforms(metrics)},
            {"volume", volume_facts(metrics)},
            {"joints", joint_facts(regions, bones)},
            {"nearer", nearer_facts(metrics, inverting)},
            {"inverting", inverting},
            {"skin", skin_facts(metrics)},
            {"widest_frame", fs::exists(distances) ? widest_frame(analysis::read_csv(distances)) : nullptr},
            {"frame_ms", frame_ms(metrics)},
            {"error_bar", error_bar_facts(metrics, run)},
            {"reference_frames", outcome.value("reference_frames", nlohmann::json())},
            {"interrupted", outcome.value("interrupted", false)},
            {"reference_lag", outcome.value("reference_lag", nlohmann::json())},
            {"control", fs::exists(folder + "/skin/artist.pvd") ? nlohmann::json("skin/artist_*.vtp") : nullptr}};
}

}  // namespace experiments
