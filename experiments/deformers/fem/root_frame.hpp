// A pose relative to its root bone, and back: the rigid motion of the whole body is removed before a quasi-static solve and applied after
// it. This is exact: all laws except the linear one are invariant under a rigid motion, and the linear one must not see any.
#pragma once

#include "pbs/skinning/pose.hpp"

namespace experiments {

class RootFrame {
public:
    RootFrame(const pbs::Skeleton& skeleton, const pbs::Pose& pose);

    const pbs::Pose& pose() const { return pose_; }          // relative to the root
    const Eigen::Isometry3d& root() const { return root_; }  // the root in the world
    pbs::Vec3 from_world(const pbs::Vec3& direction) const { return root_.linear().transpose() * direction; }
    pbs::Positions to_world(const pbs::Positions& points) const;  // [m], #points x 3
    pbs::Positions to_root(const pbs::Positions& points) const;   // its inverse

private:
    Eigen::Isometry3d root_;
    pbs::Pose pose_;
};

}  // namespace experiments
