// How much of a clip reaches a skeleton.
#pragma once

#include "pbs/character/clip.hpp"

#include <string>
#include <vector>

namespace pbs {

struct ClipMatch {
    int moving = 0;                      // joints of the clip whose rotation changes
    int matched = 0;                     // of these, joints that a bone follows
    std::vector<std::string> unmatched;  // names of the others
};

// By the same names as retarget().
ClipMatch match_of(const Clip& clip, const Skeleton& skeleton);

// The largest rotation of a bone from the first pose to another one [deg]; translations do not count.
double largest_rotation_deg(const Motion& motion);

// The largest displacement of an end of a bone from the first pose to another one [m].
double largest_displacement_m(const Motion& motion, const Skeleton& skeleton);

}  // namespace pbs
