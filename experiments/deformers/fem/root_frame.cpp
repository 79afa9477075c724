#include "experiments/deformers/fem/root_frame.hpp"

#include <algorithm>

namespace experiments {

RootFrame::RootFrame(const pbs::Skeleton& skeleton, const pbs::Pose& pose) : pose_(pose)
{
    const auto& bones = skeleton.bones;
    const auto root = std::find_if(bones.begin(), bones.end(), [](const pbs::Bone& bone) { return bone.parent < 0; });
    root_ = pose[root - bones.begin()];
    for (Eigen::Isometry3d& bone : pose_) bone = root_.inverse() * bone;
}

pbs::Positions RootFrame::to_world(const pbs::Positions& points) const
{
    return (points * root_.linear().transpose()).rowwise() + root_.translation().transpose();
}

pbs::Positions RootFrame::to_root(const pbs::Positions& points) const
{
    return (points.rowwise() - root_.translation().transpose()) * root_.linear();
}

}  // namespace experiments
