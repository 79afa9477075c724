// How each bone of a skeleton follows a clip: which joint, aligned how, with what share of whose twist.
#pragma once

#include "pbs/character/clip.hpp"

namespace pbs {

struct BoneFollowing {
    int joint = -1;                                                 // of the clip; -1: the bone follows its parent
    Eigen::Quaterniond alignment = Eigen::Quaterniond::Identity();  // A: rest direction of the bone -> limb in the zero pose
    int twist_joint = -1;                                           // -1: none
    double twist_share = 0.0;
    Vec3 limb = Vec3::Zero();  // to the end of the joint's limb in the zero pose [clip's units]
};

struct RetargetPlan {
    std::vector<BoneFollowing> bones;  // #bones
    double scale = 1.0;                // [m] per clip unit
};

RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton);

// Angle [rad], in (-pi, pi], of the twist of `rotation` about the unit vector `axis` (swing-twist decomposition).
double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis);

}  // namespace pbs
