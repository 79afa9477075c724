#include "experiments/scene/motion.hpp"

#include "experiments/characters/model_character.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/scene/movements.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace experiments {
namespace {

constexpr double noted_angle_deg = 10.0;  // between a part of the body and of the clip
constexpr double still_deg = 0.1;         // no one sees less
constexpr double still_share = 1e-3;      // over the size of the body, likewise
constexpr double rigid_stretch = 1e-3;    // rounding of exporters
constexpr double large_stretch = 0.1;  // of the distance of a bone from its parent, from which on volume is not judged
constexpr double visible_stretch = 0.01;  // over the size of the body: less is a blink or a breath

pbs::ClipSampling clip_sampling(const MotionSpec& spec)
{
    pbs::ClipSampling sampling;
    static_cast<pbs::MotionSampling&>(sampling) = sampling_of(spec);
    return sampling;
}

std::string share_of(const pbs::ClipMatch& match)
{
    const std::string aside =
        match.small > 0 ? fmt::format(" (without {} fingers, toes and the like)", match.small) : "";
    return fmt::format("{} of {} moving joints{}", match.matched, match.moving - match.small, aside);
}

// The list is empty if every moving joint matches a bone and every bone has a joint.
pbs::RemarkList remarks_on_match(const pbs::ClipMatch& match, const std::string& clip)
{
    if (match.unmatched.empty() && match.bones_without_joint.empty()) return {};
    std::string text = fmt::format("{}: {} of the clip match a bone", clip, share_of(match));
    if (!match.unmatched.empty()) text += "; without a bone: " + pbs::name_list(match.unmatched);
    if (!match.bones_without_joint.empty())
        text += "; bones without a motion of their own: " + pbs::name_list(match.bones_without_joint);
    return {{pbs::Gravity::part_left_out, text}};
}

// Names the parts of the body that point in other directions than those of the clip, over the whole motion.
std::vector<std::string> notes_on_angles(const std::vector<pbs::PartAngle>& angles, const std::string& clip)
{
    std::vector<std::string> parts;
    for (const pbs::PartAngle& angle : angles)
        if (angle.largest_deg > noted_angle_deg)
            parts.push_back(fmt::format("{} {:.0f}", angle.part, angle.largest_deg));
    if (parts.empty()) return {};
    return {
        fmt::format("{}: parts of the body point in other directions than in the clip; largest angles [degrees]: {}; "
                    "the trunk keeps the model's own "
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
        made.notes.push_back(
            spec.clip +
            ": the names of its hips, legs or neck are unknown, so that its directions are not compared with the "
            "body's; look at the first frame");
    for (const std::string& note : notes_on_angles(made.angles, spec.clip))
        if (made.is_far_from_clip())
            made.remarks.push_back({pbs::Gravity::results_wrong, note});
        else
            made.notes.push_back(note);
    const int first = pbs::first_frame_of_motion(clip);
    made.time_zero = first > 0 ? "start of the clip after its first frame, a rest pose, plus motion.start_s"
                               : "start of the clip plus motion.start_s";
    made.time_zero_s = first * clip.frame_time_s + spec.start_s;
    made.clip_joints = match.moving - match.small;
    made.matched_joints = match.matched;
    for (const pbs::Remark& remark : remarks_on_match(match, spec.clip)) made.remarks.push_back(remark);
    return made;
}

// Bones that the animation moves away from their parents or towards them, as squash and stretch does.
std::vector<StretchedBone> stretched_bones(const pbs::RigMotion& motion, const pbs::RiggedBody& body)
{
    const double size_m = pbs::diagonal_m(body.surface);
    std::vector<StretchedBone> stretched;
    for (std::size_t b = 0; b < motion.distances.size(); ++b) {
        const pbs::DistanceChange& change = motion.distances[b];
        if (std::abs(change.relative) > large_stretch && std::abs(change.change_m) > visible_stretch * size_m)
            stretched.push_back({body.skeleton.bones[b].name, 100.0 * change.relative, change.frame});
    }
    std::ranges::stable_sort(stretched, std::ranges::greater(),
                             [](const StretchedBone& bone) { return std::abs(bone.change_pct); });
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
        words.size() == 1 ? "one bone changes" : fmt::format("each of {} bones changes", words.size()),
        100.0 * large_stretch, pbs::name_list(words));
}

// The largest rotation of a bone from the rest pose [deg] where the motion is a single frame, such as an animation of
// one key; else 0.
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
        throw pbs::InputError(scene_file, 0, "motion.animation", spec.animation,
                              "the model has no animation: expected a joint or a clip");
    pbs::RigMotion rig = pbs::rig_motion(model.rig, model.body, *model.animation, sampling_of(spec));
    CaseMotion made;
    made.motion = std::move(rig.motion);
    made.time_zero = "first key of the animation plus motion.start_s";
    made.time_zero_s = model.animation->start_s + spec.start_s;
    made.stretched = stretched_bones(rig, model.body);
    if (!made.stretched.empty())
        made.remarks.push_back(
            {pbs::Gravity::comparison_wrong, fmt::format("{}: in the animation {}, {}", model.rig.file,
                                                         model.animation->name, words_on_stretch(made.stretched))});
    if (rig.stretch > rigid_stretch)
        made.remarks.push_back(
            {pbs::Gravity::part_left_out,
             fmt::format(
                 "{}: the animation {} scales or shears bones by up to {:.1f} %; the deformers move bones rigidly",
                 model.rig.file, model.animation->name, 100.0 * rig.stretch)});
    return made;
}

}  // namespace

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    if (!spec.movements.empty()) return through_movements(spec, skeleton, scene_file);
    if (spec.clip.empty()) {
        const int joint = pbs::find_bone(skeleton, spec.joint);
        std::vector<std::string> names;
        for (const auto& bone : skeleton.bones) names.push_back(bone.name);
        if (joint < 0)
            throw pbs::InputError(scene_file, 0, "motion.joint", spec.joint,
                                  fmt::format("expected one of {}", fmt::join(names, ", ")));
        return pbs::joint_sweep(skeleton, joint, spec.axis.normalized(), spec.angle_deg, spec.frames, spec.time_step_s);
    }
    return pbs::retarget(pbs::read_clip(spec.clip, spec.animation), skeleton, clip_sampling(spec));
}

void take_bones_that_move_as_one(const pbs::Motion& motion, pbs::Character& character)
{
    if (pbs::has_artist_weights(character))
        character.moves_with =
            pbs::bones_that_move_as_one(character.skeleton, motion.steps, pbs::diagonal_m(character.mesh.rest));
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
    const double size_m = rest.rows() > 0 ? pbs::diagonal_m(rest) : 0.0;
    if (const double posed_deg = pose_deg(made.motion); posed_deg >= still_deg)
        made.remarks.push_back(
            {pbs::Gravity::results_wrong,
             fmt::format(
                 "{}: the motion is one pose, in which the bones are turned by up to {:.3g} degrees from the rest "
                 "pose; nothing moves after it",
                 scene_file, posed_deg)});
    else if (made.largest_rotation_deg < still_deg && displacement_m <= still_share * size_m)
        made.remarks.push_back(
            {pbs::Gravity::results_wrong,
             fmt::format("{}: no joint moves: the bones turn by at most {:.2g} degrees and move by at most {:.2g} % of "
                         "the body's size",
                         scene_file, made.largest_rotation_deg, size_m > 0.0 ? 100.0 * displacement_m / size_m : 0.0)});
    return made;
}

pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton)
{
    pbs::ClipMatch match = pbs::match_of(clip, skeleton);
    if (2 * match.matched < match.moving - match.small && !spec.allow_partial)
        throw pbs::InputError(spec.clip, 0, "joints", share_of(match),
                              "expected at least one half to match a bone of the character: rename the joints as the "
                              "bones or as those of "
                              "Mixamo (motion.allow_partial = true in the scene, or --allow-partial of `pbskin try`, "
                              "accepts fewer); without "
                              "a bone: " +
                                  pbs::name_list(match.unmatched));
    if (!match.torn.empty() && !spec.allow_partial)
        throw pbs::InputError(spec.clip, 0, "joints of limbs", pbs::name_list(match.torn),
                              "these bones match no joint, but the other half of their limb does, so that it would be "
                              "bent wrongly: rename "
                              "the joints as the bones or as those of Mixamo (motion.allow_partial = true in the "
                              "scene, or --allow-partial of "
                              "`pbskin try`, lets them follow their parents)");
    return match;
}

pbs::MotionSampling sampling_of(const MotionSpec& spec)
{
    return {.start_s = spec.start_s,
            .duration_s = spec.duration_s,
            .rate_hz = spec.rate_hz,
            .time_step_s = spec.time_step_s};
}

}  // namespace experiments
