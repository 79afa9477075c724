// The rounding error of positions that rigid motions give, for tolerances: an entry of a rotation goes through eight roundings from an
// angle and an axis, a quaternion or a blend of two, and a coordinate through four more of its product with the entries of a row, of norm
// one.
#pragma once

#include "tests/support/rounding_error.hpp"

#include <cmath>

namespace test_support {

// The rounding error of a position after so many motions, in the unit of `farthest`, the largest norm on the way.
inline double motion_error(int motions, double farthest)
{
    return std::sqrt(3.0) * rounding_error((8.0 + 4.0) * motions, farthest);
}

// The rounding error of the matrix of their product in the Frobenius norm, of nine entries and a translation.
inline double motion_matrix_error(int motions, double translation)
{
    return 3.0 * rounding_error((8.0 + 4.0) * motions, 1.0) + motion_error(motions, translation);
}

}  // namespace test_support
