#include "pbs/skinning/pose.hpp"

#include "pbs/geometry/input_error.hpp"

#include <numbers>

namespace pbs {
namespace {

constexpr double meeting_distance_per_diagonal = 0.02;

double bounding_diagonal(const Skeleton& skeleton)
{
    Eigen::AlignedBox3d box;
    for (const Bone& bone : skeleton.bones) box.extend(bone.head).extend(bone.tail);
    return box.diagonal().norm();
}

void check_sweep(const Skeleton& skeleton, int joint, const Vec3& axis, int frames)
{
    if (joint < 0 || joint >= static_cast<int>(skeleton.bones.size()))
        throw InputError("joint sweep", 0, "joint", std::to_string(joint), "expected a bone of the skeleton");
    if (!(axis.stableNorm() > 0.0) || !axis.allFinite()) throw InputError("joint sweep", 0, "axis", "", "expected a direction, not zero");
    if (frames < 1) throw InputError("joint sweep", 0, "frames", std::to_string(frames), "expected at least 1");
}

}  // namespace

int find_bone(const Skeleton& skeleton, const std::string& name)
{
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j)
        if (skeleton.bones[j].name == name) return static_cast<int>(j);
    return -1;
}

std::vector<int> bones_meeting(const Skeleton& skeleton, int bone, BoneEnd end)
{
    const Bone& own = skeleton.bones[bone];
    const Vec3& joint = end == BoneEnd::head ? own.head : own.tail;
    const double tolerance = meeting_distance_per_diagonal * bounding_diagonal(skeleton);

    std::vector<int> meeting = {bone};
    if (end == BoneEnd::head && own.parent >= 0) meeting.push_back(own.parent);
    for (int j = 0; j < static_cast<int>(skeleton.bones.size()); ++j) {
        const Bone& other = skeleton.bones[j];
        const bool child = other.parent == bone;
        const bool sibling = end == BoneEnd::head && j != bone && other.parent == own.parent;
        if ((child || sibling) && (other.head - joint).norm() <= tolerance) meeting.push_back(j);
    }
    return meeting;
}

Pose pose_from_joints(const Skeleton& skeleton, const std::vector<Eigen::Quaterniond>& local_rotations, const Vec3& root_translation)
{
    Pose pose(skeleton.bones.size());
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const Bone& bone = skeleton.bones[j];
        const bool root = bone.parent < 0;
        const Eigen::Matrix3d local = local_rotations[j].normalized().toRotationMatrix();
        const Eigen::Matrix3d rotation = root ? local : Eigen::Matrix3d(pose[bone.parent].linear() * local);
        const Vec3 posed_head = root ? Vec3(bone.head + root_translation) : Vec3(pose[bone.parent] * bone.head);
        pose[j] = Eigen::Isometry3d::Identity();
        pose[j].linear() = rotation;
        pose[j].translation() = posed_head - rotation * bone.head;
    }
    return pose;
}

Motion joint_sweep(const Skeleton& skeleton, int joint, const Vec3& axis, double angle_deg, int frames, double time_step_s)
{
    check_sweep(skeleton, joint, axis, frames);
    Motion motion;
    motion.time_step_s = time_step_s;
    const Vec3 direction = axis.stableNormalized();
    std::vector<Eigen::Quaterniond> local_rotations(skeleton.bones.size(), Eigen::Quaterniond::Identity());
    for (int frame = 0; frame < frames; ++frame) {
        const double angle = frame == 0 ? 0.0 : angle_deg * frame / (frames - 1);
        local_rotations[joint] = Eigen::AngleAxisd(angle * std::numbers::pi / 180.0, direction);
        motion.steps.push_back(pose_from_joints(skeleton, local_rotations, Vec3::Zero()));
        motion.angle_deg.push_back(angle);
    }
    return motion;
}

}  // namespace pbs
