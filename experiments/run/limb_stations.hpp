// Where limbs are cut to find their smallest cross-section: planes across bones that flesh surrounds like a sleeve, and across the joints
// between them.
#pragma once

#include "pbs/character/character.hpp"

#include <vector>

namespace experiments {

// A plane in rest pose and the bones that carry it: the mean of their posed points and directions.
struct LimbStation {
    std::string name;           // e.g. "forearm 0.33", "upper|forearm"
    pbs::Vec3 point, normal;    // rest [m], unit
    std::vector<int> carriers;  // one bone, or the two that meet at a joint
    std::vector<int> tets;      // tets of these bones and their neighbours along the limb
};

// A bone is a limb where it is longer than 3 times the mean distance of its vertices. Stations stand at 1/6, 2/6 ... 5/6 of each, and at
// each joint between two limbs that meet at an angle below 90 degrees; but only where the limb has its flesh for itself: nine tenths of
// what the plane cuts nearby belong to it (in the trunk, many bones share it).
std::vector<LimbStation> limb_stations(const pbs::Character& character);

pbs::Vec3 posed_point(const LimbStation& station, const pbs::Pose& pose);
pbs::Vec3 posed_normal(const LimbStation& station, const pbs::Pose& pose);

}  // namespace experiments
