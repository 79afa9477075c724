#include "pbs/character/retarget_plan.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

using Rotations = std::vector<Eigen::Quaterniond>;

constexpr double rounding = 1e-6;  // of a frame: times given in decimal are not refused for their last digit

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

}  // namespace

Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling)
{
    const int first = sampling.drop_first_frame ? 1 : 0;
    if (clip.frames() <= first) throw InputError(clip.name, 0, "Frames", std::to_string(clip.frames()), "no frame is left after the first");
    const RetargetPlan plan = plan_retargeting(clip, skeleton);

    Motion motion;
    motion.time_step_s = sampling.time_step_s;
    motion.steps_per_frame = steps_per_frame(sampling);
    const double length_s = (clip.frames() - 1 - first) * clip.frame_time_s;
    const int frames = frames_after_the_first(sampling, length_s, rounding * clip.frame_time_s, clip.name);
    const int steps = frames * motion.steps_per_frame;
    for (int step = 0; step <= steps; ++step) {
        const double time_s = sampling.start_s + step * sampling.time_step_s;
        const ClipPose source = sample(clip, first + time_s / clip.frame_time_s);
        const Vec3 moved = plan.scale * (source.root - clip.root.row(first).transpose());
        motion.steps.push_back(pose_of(plan, skeleton, global_rotations(source.local, clip.parent), moved));
    }
    return motion;
}

}  // namespace pbs
