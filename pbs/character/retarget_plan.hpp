// How each bone of a skeleton follows a clip: which joint, aligned how, with what share of whose twist.
#pragma once

#include "pbs/character/clip.hpp"

namespace pbs {

// The plan of one bone.
struct BoneFollowing {
    int joint = -1;                                                 // of the clip; -1: the bone follows its parent
    Eigen::Quaterniond alignment = Eigen::Quaterniond::Identity();  // A: rest direction of the bone -> limb in the zero pose
    int twist_joint = -1;                                           // -1: none
    double twist_share = 0.0;                                       // of that joint's twist about the limb, 0 to 1
    Vec3 limb = Vec3::Zero();                                       // to the end of the joint's limb in the zero pose [clip's units]
};

// The plans of all bones of a skeleton, in its order.
struct RetargetPlan {
    std::vector<BoneFollowing> bones;  // #bones
    double scale = 1.0;  // [m] per clip unit: bones' lengths over limbs', of the legs where they are known, else of all that follow
};

// Uses CMU's joint names for the bones of the `human` (joint_map.hpp), else by equal names. InputError where no joint has the name of a
// bone, or some have CMU's and the legs' are missing.
RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton);

// Angle [rad], in (-pi, pi], of the twist of `rotation` about the unit vector `axis` (swing-twist decomposition).
double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis);

}  // namespace pbs
