// The joints of a body that a limb passes through, and how each is turned to show what blending does to it.
//   for (const LimbJoint& joint : limb_joints(character)) ...   // elbow, mid-forearm, wrist, knee
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

struct LimbJoint {
    std::string name;                      // "thigh.L|shin.L"
    int parent, child;                     // bones
    pbs::Vec3 point;                       // rest [m]
    double radius_m;                       // of the limb there: mean rest distance of the skin's vertices that hang on the two bones
    double reach_parent_m, reach_child_m;  // along each bone, how far the limb's sections are looked at
};

// Between two limbs that meet at less than 60 degrees at rest and have their flesh for themselves (limb_stations.hpp), up to half of each
// bone; of a body with two sides, those of its left (x >= 0). Bodies whose bones the rule misjudges have theirs by hand (joints_by_hand),
// with the radius of the circle that has the area of the section across the joint.
std::vector<LimbJoint> limb_joints(const pbs::Character& character);

// A joint by its bones, and on which share of each the sections go round the limb alone.
struct JointByHand {
    std::string parent, child;
    double reach_parent, reach_child;
    std::string no_section;  // why it has none; empty: it has
};
std::string name_of(const JointByHand& joint);
// Why the character has no sections there: no_section, or a bone or flesh that it has not got. Empty: it has.
std::string why_left_out(const pbs::Character& character, const JointByHand& joint);
std::vector<JointByHand> joints_by_hand(const std::string& body);  // none: the body follows the rule

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);  // the child's direction

// Across both bones, so that turning about it bends the limb on the way that it is bent at rest; of a straight one, z.
pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);

// Vertices of the two bones not farther from the joint, along them, than a third of their lengths, #V.
std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint);

}  // namespace experiments
