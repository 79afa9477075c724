// A bar that overlaps itself: an input for what leaves out such a part.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <cmath>

namespace test_support {

// A bar of length 2 along x, wound to a helix of 8 radians, whose windings are a fifth of the width apart: an angle a and a - 2 pi are both
// on the bar for a > 2 pi - 4, so that the parts with |x| > pi / 2 - 1 overlap. rest: vertices [m], #V x 3.
inline pbs::Positions wound(pbs::Positions rest)
{
    for (auto point : rest.rowwise()) {
        const double angle = 4.0 * point(0), radius = 0.3 + point(1);
        point << radius * std::sin(angle), radius * std::cos(angle), point(2) + 0.01 * angle;
    }
    return rest;
}

}  // namespace test_support
