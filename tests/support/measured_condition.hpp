// The change of a value by the rounding of the positions that it is computed from, where no bound is near: for sections of curved skin, or
// ratios of strains, whose worst case is a plane along an edge or a flat tet. The condition number is measured: random changes of all
// coordinates by up to the rounding itself change the value, and rounding is one more such change. A normally distributed change exceeds
// three times the largest of 32 others with a probability of 6e-7.
//   EXPECT_NEAR(of_float, of_double, value_rounding(positions, single_rounding_m(positions), value));
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test_support {

// value: a function of positions, in any unit, which the result has as well. rounding_m: of a coordinate. A value that is not finite is a
// failure of the test.
template <typename Value>
double value_rounding(const pbs::Positions& positions, double rounding_m, Value value)
{
    RandomPoints random(71);
    const double undisturbed = value(positions);
    double largest = 0.0;
    for (int draw = 0; draw < 32; ++draw) {
        pbs::Positions moved = positions;
        for (Eigen::Index v = 0; v < moved.rows(); ++v) moved.row(v) += random.point(rounding_m).transpose();
        const double change = std::abs(value(moved) - undisturbed);
        EXPECT_TRUE(std::isfinite(change)) << "draw " << draw;
        largest = std::max(largest, change);
    }
    return 3.0 * largest;
}

// The rounding of coordinates that are rounded to float once, relative to an origin among them.
inline double single_rounding_m(const pbs::Positions& positions)
{
    return rounding_error_in<float>(1, (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff());
}

// The rounding of coordinates that go through so many roundings in double.
inline double coordinate_rounding_m(const pbs::Positions& positions, double roundings)
{
    return rounding_error_in<double>(roundings, positions.cwiseAbs().maxCoeff());
}

}  // namespace test_support
