// A pose relative to its root bone, and back: the rigid motion of the whole body is removed before a quasi-static solve and applied after
// it. This is exact for every material law that is invariant under a rigid motion, and a linear law must not see any.
#pragma once

#include "pbs/skinning/pose.hpp"

namespace pbs {

class RootFrame {
public:
    RootFrame(const Skeleton& skeleton, const Pose& pose);

    const Pose& pose() const { return pose_; }               // relative to the root
    const Eigen::Isometry3d& root() const { return root_; }  // the root in the world
    Vec3 from_world(const Vec3& direction) const { return root_.linear().transpose() * direction; }
    Positions to_world(const Positions& points) const;  // [m], #points x 3
    Positions to_root(const Positions& points) const;   // its inverse

private:
    Eigen::Isometry3d root_;
    Pose pose_;
};

}  // namespace pbs
