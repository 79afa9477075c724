// The joints of a body that lie inside a limb, and the axes about which each is turned to show what blending does to it.
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
    double radius_m;                       // of the limb there: mean rest distance of the skin's vertices that are bound to the two bones
    double reach_parent_m, reach_child_m;  // how far along each bone sections are taken
};

// A joint lies between two bones that meet at less than 60 degrees at rest and share their flesh with no other bone
// (frame_measurement.hpp). Its reach is half of each bone. Bodies with two sides have the joints of their left side (x >= 0). Where the
// rule misjudges the bones, the joints are given by hand (joints_by_hand); their radius is that of the circle with the area of the section
// across the joint.
std::vector<LimbJoint> limb_joints(const pbs::Character& character);

// A joint given by its bones, and the share of each bone on which a section's outline encloses the limb alone.
struct JointByHand {
    std::string parent, child;
    double reach_parent, reach_child;
    std::string no_section;  // why it has no section; empty: it has
};
std::string name_of(const JointByHand& joint);
// Why the character has no sections there: no_section, or a bone or flesh that it lacks. Empty: it has sections.
std::string why_left_out(const pbs::Character& character, const JointByHand& joint);
std::vector<JointByHand> joints_by_hand(const std::string& body);  // none: the body follows the rule

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);  // the child's direction

// Across both bones, so that a turn about it bends the limb further in the direction in which it is bent at rest; z for a straight limb.
pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint);

// The vertices of the two bones that are no farther from the joint, along the bone, than a third of its length, #V.
std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint);

}  // namespace experiments
