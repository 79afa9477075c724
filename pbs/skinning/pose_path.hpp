// A path from one pose to another on which joints stay joined: each bone turns relative to its parent at an even rate, the short way round
// (slerp), and its head moves in a straight line relative to its parent. Roots turn and move in the world in the same way.
//   const PosePath path(skeleton, from, to);
//   path.at(0.5);
#pragma once

#include "pbs/skinning/pose.hpp"

namespace pbs {

class PosePath {
public:
    PosePath(const Skeleton& skeleton, const Pose& from, const Pose& to);

    Pose at(double fraction) const;   // 0: from, 1: to
    double largest_turn_deg() const;  // between the ends, of any bone

private:
    struct Joint {
        Eigen::Quaterniond rotation;  // relative to the parent
        Vec3 head;                    // its place in the parent's rest coordinates [m]
    };
    std::vector<Joint> joints_of(const Pose& pose) const;

    Skeleton skeleton_;
    Pose from_, to_;
    std::vector<Joint> start_, end_;
};

}  // namespace pbs
