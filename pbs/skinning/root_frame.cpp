#include "pbs/skinning/pose_path.hpp"

#include <algorithm>

namespace pbs {

RootFrame::RootFrame(const Skeleton& skeleton, const Pose& pose) : pose_(pose)
{
    const auto& bones = skeleton.bones;
    const auto root = std::find_if(bones.begin(), bones.end(), [](const Bone& bone) { return bone.parent < 0; });
    root_ = pose[root - bones.begin()];
    for (Eigen::Isometry3d& bone : pose_) bone = root_.inverse() * bone;
}

Positions RootFrame::to_world(const Positions& points) const
{
    return (points * root_.linear().transpose()).rowwise() + root_.translation().transpose();
}

Positions RootFrame::to_root(const Positions& points) const
{
    return (points.rowwise() - root_.translation().transpose()) * root_.linear();
}

}  // namespace pbs
