// A way from one pose to another on which joints stay joined: each bone turns relative to its parent at an even rate, the short way round
// (slerp), and its head moves on its parent in a straight line; roots turn and move so in the world.
//   const PosePath path(skeleton, from, to);
//   path.at(0.5);
#pragma once

#include "pbs/skinning/pose.hpp"

namespace experiments {

class PosePath {
public:
    PosePath(const pbs::Skeleton& skeleton, const pbs::Pose& from, const pbs::Pose& to);

    pbs::Pose at(double fraction) const;  // 0: from, 1: to
    double largest_turn_deg() const;      // between the ends, of any bone

private:
    struct Joint {
        Eigen::Quaterniond rotation;  // relative to the parent's
        pbs::Vec3 head;               // where it sits, in the parent's rest coordinates [m]
    };
    std::vector<Joint> joints_of(const pbs::Pose& pose) const;

    pbs::Skeleton skeleton_;
    pbs::Pose from_, to_;
    std::vector<Joint> start_, end_;
};

}  // namespace experiments
