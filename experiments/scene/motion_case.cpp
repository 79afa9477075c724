#include "experiments/scene/motion_case.hpp"

#include "pbs/character/clip.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace experiments {
namespace {

std::string bone_names(const pbs::Skeleton& skeleton)
{
    std::vector<std::string> names;
    for (const auto& bone : skeleton.bones) names.push_back(bone.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file)
{
    if (spec.clip.empty()) {
        const int joint = pbs::find_bone(skeleton, spec.joint);
        if (joint < 0) throw pbs::InputError(scene_file, 0, "motion.joint", spec.joint, "expected one of " + bone_names(skeleton));
        return pbs::joint_sweep(skeleton, joint, spec.axis.normalized(), spec.angle_deg, spec.frames, spec.time_step_s);
    }
    pbs::ClipSampling sampling;
    sampling.start_s = spec.start_s;
    sampling.duration_s = spec.duration_s;
    sampling.rate_hz = spec.rate_hz;
    sampling.time_step_s = spec.time_step_s;
    return pbs::retarget(pbs::read_clip(spec.clip), skeleton, sampling);
}

}  // namespace experiments
