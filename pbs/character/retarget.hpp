// How each bone of a skeleton follows a clip: which joint, aligned how, with what share of whose twist.
#pragma once

#include "pbs/character/clip.hpp"

#include <string>
#include <vector>

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

// Uses CMU's joint names for the bones of the `human` (retarget.hpp), else by equal names. InputError where no joint has the name of a
// bone, or some have CMU's and the legs' are missing.
RetargetPlan plan_retargeting(const Clip& clip, const Skeleton& skeleton);

// Angle [rad], in (-pi, pi], of the twist of `rotation` about the unit vector `axis` (swing-twist decomposition).
double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis);

// The joint of a clip that moves each bone: the names of CMU's motion capture (cgspeed's BVH conversion) for the `human` skeleton.

// One bone of the `human`.
struct JointMapping {
    // Its name in the skeleton.
    std::string bone, joint;       // of the clip, by name
    bool aligned = false;          // the bone turns to the joint's limb; false: it keeps its own rest direction (spine, neck, clavicles)
    bool leg = false;              // its length counts in the scale of the root's path
    std::string twist_joint = {};  // takes a share of this joint's twist about the limb; empty: none
    double twist_share = 0.0;      // 0 to 1
};

// CMU keeps the twist of the forearm in the wrist joint. Three joints can carry it here, elbow, mid-forearm and wrist; equal steps of a
// third at each keep the largest step least: 1/3 on the upper half, 2/3 on the lower half, all of it on the hand.
const std::vector<JointMapping>& cmu_joint_map();

}  // namespace pbs
