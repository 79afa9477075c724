#include "experiments/scene/scene.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/settings/option_fields.hpp"
#include "generated/scenes_texts.hpp"
#include "pbs/character/model_character.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/rig_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

// Messages name the file as briefly as its folders allow.
std::string in_folder(const std::string& folder, const std::string& path)
{
    if (path.empty() || fs::path(path).is_absolute()) return path;
    const fs::path file = fs::path(folder) / path;
    if (path.rfind("..", 0) != 0) return file.string();
    const fs::path whole = fs::weakly_canonical(file), from_here = whole.lexically_proximate(fs::current_path());
    return (from_here.string().rfind("..", 0) == 0 ? whole : from_here).string();
}

// One of the three: a body, a model, mesh and skeleton files.
void check_character(const SceneValues& values, const pbs::CharacterSource& source)
{
    const int sources = !source.body.empty() + !source.model_file.empty() + !source.mesh_file.empty();
    if (sources == 0) values.refuse("character.body", "expected a body, a model, or mesh and skeleton files");
    if (sources > 1)
        values.refuse(source.mesh_file.empty() ? "character.model" : "character.mesh", "expected either a body, a model or files");
    if (!source.mesh_file.empty() && source.skeleton_file.empty()) values.refuse("character.skeleton", "expected the skeleton of the mesh");
    if (values.given("character.scale") && source.model_file.empty())
        values.refuse("character.scale", "expected a character.model, which is the only thing that it enlarges");
}

pbs::CharacterSource read_character(const SceneValues& values, const std::string& folder)
{
    pbs::CharacterSource source = character_fields().read(values, "character");
    if (values.text("motion.clip").empty()) source.animation = values.text("motion.animation");
    const bool has_named_skeleton = !source.model_file.empty() && source.skeleton_file == "human";
    for (std::string* file : {&source.model_file, &source.mesh_file, &source.skeleton_file})
        if (file != &source.skeleton_file || !has_named_skeleton) *file = in_folder(folder, *file);
    check_character(values, source);
    const std::string weights = values.text("skinning.weights");
    source.weights = pbs::weights_named(weights);
    if (source.weights == pbs::WeightKind::artist && source.model_file.empty())
        values.refuse("skinning.weights", "expected a character.model, which brings the artist's weights");
    if (!weights.empty() && !source.weights) source.weights_file = in_folder(folder, weights);
    return source;
}

std::string found_clip(const SceneValues& values, const std::string& folder)
{
    try {
        return pbs::find_clip(values.text("motion.clip"), folder);
    } catch (const pbs::InputError&) {
        values.refuse("motion.clip", "expected a file in the folder of the scene, or a clip of Debian's package assimp-testmodels");
    }
}

// A frame is a whole number of steps.
void fit_time_step(const SceneValues& values, MotionSpec& motion)
{
    if (!values.given("pbs.time_step_s")) motion.time_step_s = pbs::time_step_for(motion.rate_hz);
    const double steps = 1.0 / (motion.rate_hz * motion.time_step_s);
    if (steps < 1.0 - 1e-9 || std::abs(steps - std::round(steps)) > 1e-6 * steps)
        values.refuse("motion.rate_hz", "expected rate_hz * pbs.time_step_s = 1/n with a whole number n of steps per frame");
}

MotionSpec read_motion(const SceneValues& values, const std::string& folder)
{
    MotionSpec motion = motion_fields().read(values, "motion");
    motion.time_step_s = values.number("pbs.time_step_s");
    const bool has_model = !values.text("character.model").empty();
    const bool is_of_model = !motion.animation.empty() && motion.clip.empty();  // otherwise of the clip
    if (is_of_model && !has_model) values.refuse("motion.animation", "expected a motion.clip or a character.model, which have animations");
    const int motions = !motion.joint.empty() + !motion.clip.empty() + is_of_model + !motion.movements.empty();
    if (motions > 1 || (motions == 0 && !has_model))
        values.refuse("motion.joint", "expected either a joint (a sweep), movements, a clip, or an animation of character.model");
    motion.of_model = has_model && motion.joint.empty() && motion.clip.empty() && motion.movements.empty();
    if (!motion.joint.empty() && motion.axis.norm() == 0.0) values.refuse("motion.axis", "expected an axis of non-zero length");
    if (!motion.clip.empty()) motion.clip = found_clip(values, folder);
    if (motion.joint.empty()) fit_time_step(values, motion);
    return motion;
}

// A deformer of this kind with the options of a table.
DeformerSpec read_spec(const SceneValues& values, const DeformerKind& kind, const std::string& table, const std::string& name)
{
    DeformerSpec spec = default_spec(kind.name);
    spec.name = spec.label = name;
    if (kind.read) kind.read(values, table, spec);
    return spec;
}

bool names_a_file(const std::string& name)
{
    const auto is_plain = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !name.empty() && std::all_of(name.begin(), name.end(), is_plain) && !name.starts_with("pbs");
}

std::vector<DeformerSpec> read_deformers(const SceneValues& values)
{
    const std::vector<DeformerSpec> listed = listed_deformers(values);
    std::vector<DeformerSpec> used;
    for (const std::string& name : values.texts("deformers.use")) {
        if (std::ranges::count(used, name, &DeformerSpec::name) > 0) values.refuse("deformers.use", "names " + name + " twice");
        const auto of_list = std::ranges::find(listed, name, &DeformerSpec::name);
        const DeformerKind* kind = find_deformer_kind(name);
        if (of_list != listed.end())
            used.push_back(*of_list);
        else if (kind && !kind->needs_list)
            used.push_back(read_spec(values, *kind, name, name));
        else
            values.refuse("deformers.use", "expected a deformer of `pbskin list deformers` or the name of a [[fem]] table, not " + name);
    }
    if (used.empty()) values.refuse("deformers.use", "expected at least one deformer");
    return used;
}

std::string read_reference(const SceneValues& values, const std::vector<DeformerSpec>& deformers)
{
    const std::string name = values.text("reference.name");
    const bool used = std::ranges::count(deformers, name, &DeformerSpec::name) > 0;
    if (!name.empty() && !used) values.refuse("reference.name", "expected a deformer that the scene uses");
    return name;
}

OutputSpec read_output(const SceneValues& values)
{
    OutputSpec output = output_fields().read(values, "output");
    if (const auto names = values.texts("output.frame_names"); !names.empty() && names.size() != output.frames.size())
        values.refuse("output.frame_names", "expected a name for each of output.frames");
    const auto groups = values.texts("output.metrics");
    for (const auto& group : groups)
        if (group != "all" && group != "errors" && group != "sections" && group != "surface")
            values.refuse("output.metrics", "expected errors, sections, surface or all, not " + group);
    const auto asked = [&](const char* group) {
        return std::count(groups.begin(), groups.end(), group) + std::count(groups.begin(), groups.end(), "all") > 0;
    };
    output.errors = asked("errors");
    output.sections = asked("sections");
    output.surface = asked("surface");
    return output;
}

// The reference's options; null: there is no reference, or it is no [[fem]] table.
const FemOptions* fem_reference(const std::string& reference, const std::vector<DeformerSpec>& deformers)
{
    const auto spec = std::ranges::find(deformers, reference, &DeformerSpec::name);
    return spec == deformers.end() ? nullptr : options_if<FemOptions>(*spec);
}

double read_reference_seconds(const SceneValues& values, const FemOptions* fem, ErrorBar error_bar)
{
    const double seconds = values.number("reference.seconds");
    if (seconds == 0.0) return seconds;
    if (!fem || fem->dynamics != reference_fem::Dynamics::quasi_static)
        values.refuse("reference.seconds", "expected 0 if the reference is not a quasi-static [[fem]] table");
    if (error_bar != ErrorBar::none)
        values.refuse("reference.seconds", "expected 0 with reference.error_bar, whose further solutions belong to every frame");
    return seconds;
}

ErrorBar read_error_bar(const SceneValues& values, const FemOptions* fem, const OutputSpec& output)
{
    const ErrorBar error_bar = option_of<ErrorBar>(values.text("reference.error_bar"));
    if (error_bar == ErrorBar::none) return error_bar;
    if (!fem)
        values.refuse("reference.error_bar", "expected none if the reference is not a [[fem]] table, for it has no elements to refine");
    if (fem->formulation == reference_fem::Formulation::taylor_hood)
        values.refuse("reference.error_bar", "expected none with formulation taylor_hood, which has only order 2");
    if (!output.errors) values.refuse("reference.error_bar", "expected none if output.metrics leaves out the errors, which it belongs to");
    return error_bar;
}

std::string read_scene_text(const std::string& path)
{
    std::error_code code;
    if (!fs::is_regular_file(path, code))
        throw pbs::InputError(path, 0, "", "", "cannot be read: expected a scene file, or a name of `pbskin list scenes`");
    if (pbs::is_rig_file(path))
        throw pbs::InputError(path, 0, "", "",
                              "is a model; a scene is a TOML file that names a model, a motion and deformers: `pbskin try " + path +
                                  "` runs the model and writes such a scene");
    return pbs::read_text_file(path, pbs::most_settings_bytes);
}

constexpr double noted_angle_deg = 10.0;  // between a part of the body and of the clip
constexpr double still_deg = 0.1;         // no one sees less
constexpr double still_share = 1e-3;      // over the size of the body, likewise
constexpr double rigid_stretch = 1e-3;    // rounding of exporters
constexpr double large_stretch = 0.1;     // of the distance of a bone from its parent, from which on volume is not judged
constexpr double visible_stretch = 0.01;  // over the size of the body: less is a blink or a breath

pbs::ClipSampling clip_sampling(const MotionSpec& spec)
{
    pbs::ClipSampling sampling;
    static_cast<pbs::MotionSampling&>(sampling) = sampling_of(spec);
    return sampling;
}

std::string share_of(const pbs::ClipMatch& match)
{
    const std::string aside = match.small > 0 ? fmt::format(" (without {} fingers, toes and the like)", match.small) : "";
    return fmt::format("{} of {} moving joints{}", match.matched, match.moving - match.small, aside);
}

// Of a clip that leaves anything out; nothing otherwise.
pbs::RemarkList remarks_on_match(const pbs::ClipMatch& match, const std::string& clip)
{
    if (match.unmatched.empty() && match.bones_without_joint.empty()) return {};
    std::string text = fmt::format("{}: {} of the clip match a bone", clip, share_of(match));
    if (!match.unmatched.empty()) text += "; without a bone: " + pbs::name_list(match.unmatched);
    if (!match.bones_without_joint.empty()) text += "; bones without a motion of their own: " + pbs::name_list(match.bones_without_joint);
    return {{pbs::Gravity::part_left_out, text}};
}

// Names the parts of the body that point in other directions than those of the clip, over the whole motion.
std::vector<std::string> notes_on_angles(const std::vector<pbs::PartAngle>& angles, const std::string& clip)
{
    std::vector<std::string> parts;
    for (const pbs::PartAngle& angle : angles)
        if (angle.largest_deg > noted_angle_deg) parts.push_back(fmt::format("{} {:.0f}", angle.part, angle.largest_deg));
    if (parts.empty()) return {};
    return {fmt::format(
        "{}: parts of the body point in other directions than in the clip; largest angles [degrees]: {}; the trunk keeps the model's own "
        "posture, and bones without a joint follow their parent",
        clip, fmt::join(parts, ", "))};
}

CaseMotion motion_of_clip(const MotionSpec& spec, const pbs::Character& character)
{
    const pbs::Clip clip = pbs::read_clip(spec.clip, spec.animation);
    const pbs::ClipMatch match = accepted_match(spec, clip, character.skeleton);
    CaseMotion made;
    made.motion = pbs::retarget(clip, character.skeleton, clip_sampling(spec), &made.angles);
    made.notes = clip.remarks;
    if (std::ranges::none_of(made.angles, [](const pbs::PartAngle& angle) { return angle.part == "hips"; }))
        made.notes.push_back(spec.clip +
                             ": the names of its hips, legs or neck are unknown, so that its directions are not compared with the "
                             "body's; look at the first frame");
    for (const std::string& note : notes_on_angles(made.angles, spec.clip))
        if (made.is_far_from_clip())
            made.remarks.push_back({pbs::Gravity::results_wrong, note});
        else
            made.notes.push_back(note);
    made.time_zero = "start of the clip after its first frame, a T pose, plus motion.start_s";
    made.time_zero_s = clip.frame_time_s + spec.start_s;
    made.clip_joints = match.moving - match.small;
    made.matched_joints = match.matched;
    for (const pbs::Remark& remark : remarks_on_match(match, spec.clip)) made.remarks.push_back(remark);
    return made;
}

// Bones that the animation moves away from their parents or towards them, as squash and stretch does.
std::vector<StretchedBone> stretched_bones(const pbs::RigMotion& motion, const pbs::RiggedBody& body)
{
    const double size_m = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).norm();
    std::vector<StretchedBone> stretched;
    for (std::size_t b = 0; b < motion.distances.size(); ++b) {
        const pbs::DistanceChange& change = motion.distances[b];
        if (std::abs(change.relative) > large_stretch && std::abs(change.change_m) > visible_stretch * size_m)
            stretched.push_back({body.skeleton.bones[b].name, 100.0 * change.relative, change.frame});
    }
    std::ranges::stable_sort(stretched, std::ranges::greater(), [](const StretchedBone& bone) { return std::abs(bone.change_pct); });
    return stretched;
}

std::string words_on_stretch(const std::vector<StretchedBone>& stretched)
{
    std::vector<std::string> words;
    for (const StretchedBone& bone : stretched)
        words.push_back(fmt::format("{} by {:+.0f} % in frame {}", bone.bone, bone.change_pct, bone.frame));
    return fmt::format(
        "{} its distance from its parent by more than {:.0f} %, most: {}; the artist changes the volume with "
        "it, so that no method is judged by its volume",
        words.size() == 1 ? "one bone changes" : fmt::format("each of {} bones changes", words.size()), 100.0 * large_stretch,
        pbs::name_list(words));
}

// The largest rotation of a bone from the rest pose [deg] where the motion is a single frame, such as an animation of one key; else 0.
double pose_deg(const pbs::Motion& motion)
{
    if (motion.frames() != 1) return 0.0;
    const pbs::Pose rest(motion.steps.front().size(), Eigen::Isometry3d::Identity());
    return pbs::largest_rotation_deg({.steps = {rest, motion.steps.front()}});
}

CaseMotion motion_of_model(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file)
{
    const pbs::RiggedModel& model = *character.artist->model;
    if (!model.animation)
        throw pbs::InputError(scene_file, 0, "motion.animation", spec.animation, "the model has no animation: expected a joint or a clip");
    pbs::RigMotion rig = pbs::rig_motion(model.rig, model.body, *model.animation, sampling_of(spec));
    CaseMotion made;
    made.motion = std::move(rig.motion);
    made.time_zero = "first key of the animation plus motion.start_s";
    made.time_zero_s = model.animation->start_s + spec.start_s;
    made.stretched = stretched_bones(rig, model.body);
    if (!made.stretched.empty())
        made.remarks.push_back({pbs::Gravity::comparison_wrong, fmt::format("{}: in the animation {}, {}", model.rig.file,
                                                                            model.animation->name, words_on_stretch(made.stretched))});
    if (rig.stretch > rigid_stretch)
        made.remarks.push_back(
            {pbs::Gravity::part_left_out,
             fmt::format("{}: the animation {} scales or shears bones by up to {:.1f} %; the deformers move bones rigidly", model.rig.file,
                         model.animation->name, 100.0 * rig.stretch)});
    return made;
}

}  // namespace

std::vector<DeformerSpec> listed_deformers(const SceneValues& values)
{
    std::vector<DeformerSpec> listed;
    for (const DeformerKind& kind : deformer_kinds())
        for (int i = 0; kind.has_list && i < values.tables(kind.name); ++i) {
            const std::string table = kind.name + "." + std::to_string(i), name = values.text(table + ".name");
            if (!names_a_file(name))
                values.refuse(table + ".name", "expected letters, digits and underscores, not beginning with pbs: it names files");
            const DeformerSpec spec = read_spec(values, kind, table, name);
            const bool is_own_name = kind.needs_list && name == kind.name;
            if (!is_own_name && find_deformer_kind(name)) values.refuse(table + ".name", "is the name of another deformer");
            if (std::ranges::count(listed, name, &DeformerSpec::name) > 0) values.refuse(table + ".name", "is used twice");
            listed.push_back(spec);
        }
    return listed;
}

SceneSchema scene_schema()
{
    return scene_schema(deformer_kinds());
}

bool OutputSpec::writes(int frame) const
{
    return (frames_every > 0 && frame % frames_every == 0) || std::count(frames.begin(), frames.end(), frame) > 0;
}

nlohmann::json to_json(const Scene& scene)
{
    nlohmann::json resolved = scene.resolved;
    resolved["name"] = scene.name;
    resolved["runs"] = nlohmann::json::array();
    for (const DeformerSpec& spec : scene.deformers) resolved["runs"].push_back(to_json(spec));
    return resolved;
}

const std::vector<BuiltInScene>& built_in_scenes()
{
    static const std::vector<BuiltInScene> built_in = {
        {"limb_twist", scenes::limb_twist_toml, "the capsule limb, its forearm twisted by 0 to 180 degrees"},
        {"limb_bend", scenes::limb_bend_toml, "the capsule limb, its forearm bent by 0 to 150 degrees"},
        {"human_01_01", scenes::human_01_01_toml, "MakeHuman's body through CMU's clip 01_01 (repeated jumps)"},
        {"man_01_01", scenes::man_01_01_toml, "Man, as large as Table 1's, through the same clip (`pbskin fetch man`)"},
        {"lady_01_01", scenes::lady_01_01_toml, "Lady, as large as Table 1's, through the same clip (`pbskin fetch lady`)"},
        {"frankie_01_01", scenes::frankie_01_01_toml,
         "Frankie, as large as Table 1's bunny, through the same clip (`pbskin fetch frankie`)"},
        {"lady_walk", scenes::lady_walk_toml, "Lady walking: the first two and a half seconds of CMU's clip 01_03 (`pbskin fetch lady`)"},
    };
    return built_in;
}

Scene read_scene(const std::string& file_or_name, const std::vector<std::string>& overrides)
{
    const auto found = std::ranges::find(built_in_scenes(), file_or_name, &BuiltInScene::name);
    const bool from_file = found == built_in_scenes().end();
    const std::string file = from_file ? file_or_name : file_or_name + ".toml";
    const std::string folder = from_file ? fs::path(file).parent_path().string() : "";
    const SceneValues values(from_file ? read_scene_text(file) : found->text, file, overrides, scene_schema());
    warn(values.remarks());

    Scene scene;
    scene.file = file;
    scene.name = fs::path(file).stem().string();
    if (!analysis::is_utf8(scene.name))
        throw pbs::InputError(file, 0, "", "", "expected a file's name in UTF-8: it names the scene in all records");
    scene.character = read_character(values, folder);
    scene.motion = read_motion(values, folder);
    scene.deformers = read_deformers(values);
    scene.reference = read_reference(values, scene.deformers);
    scene.output = read_output(values);
    const FemOptions* fem = fem_reference(scene.reference, scene.deformers);
    scene.error_bar = read_error_bar(values, fem, scene.output);
    scene.reference_seconds = read_reference_seconds(values, fem, scene.error_bar);
    scene.resolved = values.resolved();
    scene.resolved["pbs"]["time_step_s"] = scene.motion.time_step_s;
    return scene;
}

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    if (!spec.movements.empty()) return through_movements(spec, skeleton, scene_file);
    if (spec.clip.empty()) {
        const int joint = pbs::find_bone(skeleton, spec.joint);
        std::vector<std::string> names;
        for (const auto& bone : skeleton.bones) names.push_back(bone.name);
        if (joint < 0)
            throw pbs::InputError(scene_file, 0, "motion.joint", spec.joint, fmt::format("expected one of {}", fmt::join(names, ", ")));
        return pbs::joint_sweep(skeleton, joint, spec.axis.normalized(), spec.angle_deg, spec.frames, spec.time_step_s);
    }
    return pbs::retarget(pbs::read_clip(spec.clip, spec.animation), skeleton, clip_sampling(spec));
}

CaseMotion make_case_motion(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file)
{
    CaseMotion made;
    if (spec.of_model) {
        made = motion_of_model(spec, character, scene_file);
    } else if (!spec.clip.empty()) {
        made = motion_of_clip(spec, character);
    } else {
        made.motion = make_motion(spec, character.skeleton, scene_file);
        made.time_zero = "rest pose, where the motion begins";
    }
    made.largest_rotation_deg = pbs::largest_rotation_deg(made.motion);
    const double displacement_m = pbs::largest_displacement_m(made.motion, character.skeleton);
    const pbs::Positions& rest = character.mesh.rest;
    const double size_m = rest.rows() > 0 ? (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm() : 0.0;
    if (const double posed_deg = pose_deg(made.motion); posed_deg >= still_deg)
        made.remarks.push_back(
            {pbs::Gravity::results_wrong,
             fmt::format("{}: the motion is one pose, in which the bones are turned by up to {:.3g} degrees from the rest "
                         "pose; nothing moves after it",
                         scene_file, posed_deg)});
    else if (made.largest_rotation_deg < still_deg && displacement_m <= still_share * size_m)
        made.remarks.push_back(
            {pbs::Gravity::results_wrong,
             fmt::format("{}: no joint moves: the bones turn by at most {:.2g} degrees and move by at most {:.2g} % of the body's size",
                         scene_file, made.largest_rotation_deg, size_m > 0.0 ? 100.0 * displacement_m / size_m : 0.0)});
    return made;
}

pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton)
{
    pbs::ClipMatch match = pbs::match_of(clip, skeleton);
    if (2 * match.matched < match.moving - match.small && !spec.allow_partial)
        throw pbs::InputError(
            spec.clip, 0, "joints", share_of(match),
            "expected at least one half to match a bone of the character: rename the joints as the bones or as those of "
            "Mixamo (motion.allow_partial = true in the scene, or --allow-partial of `pbskin try`, accepts fewer); without "
            "a bone: " +
                pbs::name_list(match.unmatched));
    if (!match.torn.empty() && !spec.allow_partial)
        throw pbs::InputError(
            spec.clip, 0, "joints of limbs", pbs::name_list(match.torn),
            "these bones match no joint, but the other half of their limb does, so that it would be bent wrongly: rename "
            "the joints as the bones or as those of Mixamo (motion.allow_partial = true in the scene, or --allow-partial of "
            "`pbskin try`, lets them follow their parents)");
    return match;
}

pbs::MotionSampling sampling_of(const MotionSpec& spec)
{
    return {.start_s = spec.start_s, .duration_s = spec.duration_s, .rate_hz = spec.rate_hz, .time_step_s = spec.time_step_s};
}

}  // namespace experiments
