// The joints of a body that a limb passes through, and how each is turned to show what blending does to it.
//   for (const LimbJoint& joint : limb_joints(character)) ...   // elbow, mid-forearm, wrist, knee
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

struct LimbJoint {
    std::string name;                    // "thigh.L|shin.L"
    int parent, child;                   // bones
    pbs::Vec3 point;                     // rest [m]
    double radius_m;                     // of the limb there: mean rest distance of the skin's vertices that hang on the two bones
    double half_parent_m, half_child_m;  // half of each bone's length
};

// Between two limbs that meet at less than 60 degrees at rest and have their flesh for themselves (limb_stations.hpp); of a body with two
// sides, those of its left (x >= 0).
std::vector<LimbJoint> limb_joints(const pbs::Character& character);

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);  // the child's direction

// Across both bones, so that turning about it bends the limb on the way that it is bent at rest; of a straight one, z.
pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);

// Vertices of the two bones not farther from the joint, along them, than a third of their lengths, #V.
std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint);

}  // namespace experiments
