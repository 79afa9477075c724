#include "pbs/skinning/pose_path.hpp"

#include <algorithm>
#include <numbers>

namespace pbs {
namespace {

Eigen::Isometry3d parent_of(const Bone& bone, const Pose& pose)
{
    return bone.parent < 0 ? Eigen::Isometry3d::Identity() : pose[bone.parent];
}

}  // namespace

PosePath::PosePath(const Skeleton& skeleton, const Pose& from, const Pose& to)
    : skeleton_(skeleton), from_(from), to_(to), start_(joints_of(from)), end_(joints_of(to))
{
}

std::vector<PosePath::Joint> PosePath::joints_of(const Pose& pose) const
{
    std::vector<Joint> joints;
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const Bone& bone = skeleton_.bones[j];
        const Eigen::Isometry3d in_parent = parent_of(bone, pose).inverse() * pose[j];
        joints.push_back({Eigen::Quaterniond(in_parent.linear()), in_parent * bone.head});
    }
    return joints;
}

Pose PosePath::at(double fraction) const
{
    if (fraction == 0.0) return from_;
    if (fraction == 1.0) return to_;
    Pose pose(from_.size(), Eigen::Isometry3d::Identity());
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const Bone& bone = skeleton_.bones[j];
        const Eigen::Isometry3d parent = parent_of(bone, pose);
        const Vec3 head = parent * Vec3((1.0 - fraction) * start_[j].head + fraction * end_[j].head);
        pose[j].linear() = parent.linear() * start_[j].rotation.slerp(fraction, end_[j].rotation).toRotationMatrix();
        pose[j].translation() = head - pose[j].linear() * bone.head;
    }
    return pose;
}

double PosePath::largest_turn_deg() const
{
    double largest = 0.0;
    for (std::size_t j = 0; j < from_.size(); ++j)
        largest = std::max(largest, Eigen::Quaterniond(from_[j].linear()).angularDistance(Eigen::Quaterniond(to_[j].linear())));
    return largest * 180.0 / std::numbers::pi;
}

}  // namespace pbs
