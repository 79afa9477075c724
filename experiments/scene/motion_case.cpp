#include "experiments/scene/scene.hpp"

#include "pbs/character/model_character.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace experiments {
namespace {

constexpr double still_deg = 0.1;       // no one sees less
constexpr double still_share = 1e-3;    // over the size of the body, likewise
constexpr double rigid_stretch = 1e-3;  // rounding of exporters

std::string bone_names(const pbs::Skeleton& skeleton)
{
    std::vector<std::string> names;
    for (const auto& bone : skeleton.bones) names.push_back(bone.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

pbs::ClipSampling clip_sampling(const MotionSpec& spec)
{
    pbs::ClipSampling sampling;
    static_cast<pbs::MotionSampling&>(sampling) = sampling_of(spec);
    return sampling;
}

std::string share_of(const pbs::ClipMatch& match)
{
    return fmt::format("{} of {} moving joints", match.matched, match.moving);
}

CaseMotion motion_of_clip(const MotionSpec& spec, const pbs::Character& character)
{
    const pbs::Clip clip = pbs::read_clip(spec.clip);
    const pbs::ClipMatch match = accepted_match(spec, clip, character.skeleton);
    CaseMotion made;
    made.motion = pbs::retarget(clip, character.skeleton, clip_sampling(spec));
    made.clip_joints = match.moving;
    made.matched_joints = match.matched;
    if (match.matched < match.moving)
        made.partial_match =
            fmt::format("{}: {} of the clip match a bone; without a bone: {}", spec.clip, share_of(match), pbs::name_list(match.unmatched));
    return made;
}

CaseMotion motion_of_model(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file)
{
    const pbs::RiggedModel& model = *character.artist->model;
    if (!model.animation)
        throw pbs::InputError(scene_file, 0, "motion.animation", spec.animation, "the model has no animation: expected a joint or a clip");
    pbs::RigMotion rig = pbs::rig_motion(model.rig, model.body, *model.animation, sampling_of(spec));
    CaseMotion made;
    made.motion = std::move(rig.motion);
    if (rig.stretch > rigid_stretch)
        made.remarks.push_back(
            fmt::format("{}: the animation {} scales or shears bones by up to {:.1f} %; the deformers move bones rigidly", model.rig.file,
                        model.animation->name, 100.0 * rig.stretch));
    return made;
}

}  // namespace

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    if (spec.clip.empty()) {
        const int joint = pbs::find_bone(skeleton, spec.joint);
        if (joint < 0) throw pbs::InputError(scene_file, 0, "motion.joint", spec.joint, "expected one of " + bone_names(skeleton));
        return pbs::joint_sweep(skeleton, joint, spec.axis.normalized(), spec.angle_deg, spec.frames, spec.time_step_s);
    }
    return pbs::retarget(pbs::read_clip(spec.clip), skeleton, clip_sampling(spec));
}

CaseMotion make_case_motion(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file)
{
    CaseMotion made;
    if (spec.of_model)
        made = motion_of_model(spec, character, scene_file);
    else if (!spec.clip.empty())
        made = motion_of_clip(spec, character);
    else
        made.motion = make_motion(spec, character.skeleton, scene_file);
    made.largest_rotation_deg = pbs::largest_rotation_deg(made.motion);
    const double displacement_m = pbs::largest_displacement_m(made.motion, character.skeleton);
    const pbs::Positions& rest = character.mesh.rest;
    const double size_m = rest.rows() > 0 ? (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm() : 0.0;
    if (made.largest_rotation_deg < still_deg && displacement_m <= still_share * size_m)
        made.remarks.push_back(fmt::format("{}: no joint moves: the bones turn by at most {:.2g} degrees and move by at most {:.2g} m",
                                           scene_file, made.largest_rotation_deg, displacement_m));
    return made;
}

pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton)
{
    pbs::ClipMatch match = pbs::match_of(clip, skeleton);
    if (2 * match.matched < match.moving && !spec.allow_partial)
        throw pbs::InputError(spec.clip, 0, "joints", share_of(match),
                              "expected at least one half to match a bone of the character (motion.allow_partial = true in the scene, or "
                              "--allow-partial of `pbskin try`, accepts fewer); without a bone: " +
                                  pbs::name_list(match.unmatched));
    return match;
}

pbs::MotionSampling sampling_of(const MotionSpec& spec)
{
    return {.start_s = spec.start_s, .duration_s = spec.duration_s, .rate_hz = spec.rate_hz, .time_step_s = spec.time_step_s};
}

}  // namespace experiments
