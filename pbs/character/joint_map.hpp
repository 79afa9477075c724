// The joint of a clip that moves each bone: the names of CMU's motion capture (cgspeed's BVH conversion) for the `human` skeleton.
#pragma once

#include <string>
#include <vector>

namespace pbs {

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
