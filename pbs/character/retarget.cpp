#include "pbs/character/retarget_plan.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

using Rotations = std::vector<Eigen::Quaterniond>;

constexpr double most_steps_per_frame = 1e5;
constexpr double rounding = 1e-6;  // of a step or frame: times given in decimal are not refused for their last digit

// Local rotations and root position of the clip at `frame`, which may lie between two.
struct ClipPose {
    Rotations local;
    Vec3 root;
};

ClipPose sample(const Clip& clip, double frame)
{
    const int before = std::clamp(static_cast<int>(std::floor(frame)), 0, clip.frames() - 1);
    const int after = std::min(before + 1, clip.frames() - 1);
    const double between = std::clamp(frame - before, 0.0, 1.0);
    ClipPose pose;
    for (std::size_t j = 0; j < clip.joints.size(); ++j) pose.local.push_back(clip.local[before][j].slerp(between, clip.local[after][j]));
    pose.root = (1.0 - between) * clip.root.row(before) + between * clip.root.row(after);
    return pose;
}

Rotations global_rotations(const Rotations& local, const std::vector<int>& parent)
{
    Rotations global;
    for (std::size_t j = 0; j < local.size(); ++j) global.push_back(parent[j] < 0 ? local[j] : global[parent[j]] * local[j]);
    return global;
}

// R_bone = R_joint (share of the twist) A.
Eigen::Quaterniond bone_rotation(const BoneFollowing& bone, const Rotations& joints)
{
    const Eigen::Quaterniond& joint = joints[bone.joint];
    if (bone.twist_joint < 0) return joint * bone.alignment;
    const Vec3 axis = bone.limb.normalized();
    const double angle = twist_angle(joint.conjugate() * joints[bone.twist_joint], axis);
    return joint * Eigen::AngleAxisd(bone.twist_share * angle, axis) * bone.alignment;
}

Pose pose_of(const RetargetPlan& plan, const Skeleton& skeleton, const Rotations& joints, const Vec3& root_translation)
{
    Rotations global, local;
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        const int parent = skeleton.bones[b].parent;
        const Eigen::Quaterniond above = parent < 0 ? Eigen::Quaterniond::Identity() : global[parent];
        global.push_back(plan.bones[b].joint < 0 ? above : bone_rotation(plan.bones[b], joints));
        local.push_back((above.conjugate() * global.back()).normalized());
    }
    return pose_from_joints(skeleton, local, root_translation);
}

int steps_per_frame(const ClipSampling& sampling)
{
    if (!(sampling.rate_hz > 0.0)) throw InputError("", 0, "rate_hz", std::to_string(sampling.rate_hz), "expected a rate > 0");
    if (!(sampling.time_step_s > 0.0)) throw InputError("", 0, "time_step_s", std::to_string(sampling.time_step_s), "expected a time > 0");
    const double steps = 1.0 / (sampling.rate_hz * sampling.time_step_s);
    if (!(std::round(steps) >= 1.0 && std::abs(steps - std::round(steps)) <= rounding * steps))
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps), "expected 1 / n: n steps a frame");
    if (steps > most_steps_per_frame)
        throw InputError("", 0, "rate_hz * time_step_s", std::to_string(1.0 / steps), "expected at most 100000 steps a frame");
    return static_cast<int>(std::round(steps));
}

// Number of output frames after the first.
int frames_to_make(const Clip& clip, int first, const ClipSampling& sampling)
{
    const double length_s = (clip.frames() - 1 - first) * clip.frame_time_s;
    const double slack_s = rounding * clip.frame_time_s;
    if (!(sampling.start_s >= 0.0 && sampling.start_s <= length_s + slack_s))
        throw InputError(clip.name, 0, "start_s", std::to_string(sampling.start_s), "the clip lasts " + std::to_string(length_s) + " s");
    if (!(sampling.duration_s >= 0.0 && sampling.start_s + sampling.duration_s <= length_s + slack_s))
        throw InputError(clip.name, 0, "duration_s", std::to_string(sampling.duration_s),
                         "the clip ends at " + std::to_string(length_s) + " s, " + std::to_string(length_s - sampling.start_s) + " s on");
    const double duration_s = sampling.duration_s > 0.0 ? sampling.duration_s : length_s - sampling.start_s;
    return static_cast<int>(std::floor(duration_s * sampling.rate_hz + rounding));
}

}  // namespace

Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling)
{
    const int first = sampling.drop_first_frame ? 1 : 0;
    if (clip.frames() <= first) throw InputError(clip.name, 0, "Frames", std::to_string(clip.frames()), "no frame is left after the first");
    const RetargetPlan plan = plan_retargeting(clip, skeleton);

    Motion motion;
    motion.time_step_s = sampling.time_step_s;
    motion.steps_per_frame = steps_per_frame(sampling);
    const int steps = frames_to_make(clip, first, sampling) * motion.steps_per_frame;
    for (int step = 0; step <= steps; ++step) {
        const double time_s = sampling.start_s + step * sampling.time_step_s;
        const ClipPose source = sample(clip, first + time_s / clip.frame_time_s);
        const Vec3 moved = plan.scale * (source.root - clip.root.row(first).transpose());
        motion.steps.push_back(pose_of(plan, skeleton, global_rotations(source.local, clip.parent), moved));
    }
    return motion;
}

}  // namespace pbs
