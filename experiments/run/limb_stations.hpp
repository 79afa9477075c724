// The planes that cut limbs to find their smallest cross-section: across bones that flesh surrounds like a sleeve, and across the joints
// between such bones.
#pragma once

#include "pbs/character/character.hpp"

#include <vector>

namespace experiments {

// A plane in the rest pose, and the bones that move it: its posed point and normal are the means over these bones.
struct LimbStation {
    std::string name;           // e.g. "forearm 0.33", "upper|forearm"
    pbs::Vec3 point, normal;    // rest [m], unit
    std::vector<int> carriers;  // one bone, or the two that meet at the joint
    std::vector<int> tets;      // tets of these bones and their neighbours along the limb
};

// A bone is a limb if it is longer than 3 times the mean distance of its vertices. Stations are at 1/6, 2/6 ... 5/6 of each limb, and at
// each joint between two limbs that meet at an angle below 90 degrees. A station is left out if the limb shares its flesh with other bones,
// as in the trunk: less than nine tenths of the area that the plane cuts nearby belongs to the limb.
std::vector<LimbStation> limb_stations(const pbs::Character& character);

pbs::Vec3 posed_point(const LimbStation& station, const pbs::Pose& pose);
pbs::Vec3 posed_normal(const LimbStation& station, const pbs::Pose& pose);

}  // namespace experiments
