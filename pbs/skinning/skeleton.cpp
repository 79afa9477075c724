#include "pbs/skinning/pose.hpp"

namespace pbs {
namespace {

constexpr double meeting_distance_per_diagonal = 0.02;

double bounding_diagonal(const Skeleton& skeleton)
{
    Vec3 lower = skeleton.bones.front().head, upper = lower;
    for (const Bone& bone : skeleton.bones) {
        lower = lower.cwiseMin(bone.head).cwiseMin(bone.tail);
        upper = upper.cwiseMax(bone.head).cwiseMax(bone.tail);
    }
    return (upper - lower).norm();
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

}  // namespace pbs
