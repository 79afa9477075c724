// Factors, fields and refusals. Reference: the formulas of the header, evaluated by hand. Tolerances: the rounding of values, which does
// not shrink with their differences.
#include "analysis/grid_convergence.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using analysis::GridConvergence;
using test_support::rounding_error;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// |f1 - f2| = 0.3, r = 2, p = 1: the limit lies 0.3 beyond the finer and 0.6 beyond the coarser.
TEST(TwoGrids, AreBoundedByThreeTimesTheDistanceFromTheLimit)
{
    const GridConvergence grids = analysis::two_grids({1.0, 1.3}, 2.0, 1.0);
    EXPECT_NEAR(grids.extrapolated, 0.7, rounding_error(3, 1.3));
    EXPECT_NEAR(grids.bounds[0], 0.9, 3.0 * rounding_error(3 + 2, 1.3));
    EXPECT_NEAR(grids.bounds[1], 1.8, 3.0 * rounding_error(3 + 2, 1.3));
}

// With the presumed order 1 the factor of 3 holds down to an observed order of log2(6 / 5).
TEST(TwoGrids, AtOrderOneCoverSlowerConvergence)
{
    for (const double order : {0.27, 0.5, 1.0, 2.0, 3.0}) {
        const auto error = [&](double h) { return std::pow(h, order); };
        EXPECT_GE(analysis::two_fields(error(1.0) - error(0.5), 2.0, 1.0).bounds[1], error(1.0)) << order;
    }
    const auto too_slow = [](double h) { return std::pow(h, 0.25); };
    EXPECT_LT(analysis::two_fields(too_slow(1.0) - too_slow(0.5), 2.0, 1.0).bounds[1], too_slow(1.0));
}

TEST(TwoGrids, ThatDoNotChangeHaveNoError)
{
    EXPECT_EQ(analysis::two_grids({4.0, 4.0}, 1.5, 2.0).extrapolated, 4.0);
    EXPECT_EQ(analysis::two_grids({4.0, 4.0}, 1.5, 2.0).bounds[1], 0.0);
    EXPECT_EQ(analysis::two_fields(0.0, 2.0, 1.0).bounds[1], 0.0);
    EXPECT_TRUE(std::isnan(analysis::two_fields(1.0, 2.0, 1.0).extrapolated));
}

TEST(TwoGrids, ThatAreNotFiniteAreReportedNotRefused)
{
    for (const double broken : {nan, std::numeric_limits<double>::infinity()})
        for (const double bound : analysis::two_grids({1.0, broken}, 2.0, 2.0).bounds) EXPECT_FALSE(std::isfinite(bound));
}

std::string refusal_of(double ratio, double order)
{
    try {
        analysis::two_grids({1.0, 2.0}, ratio, order);
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(TwoGrids, RefuseMeshesThatAreTooSimilarAndOrdersThatAreNone)
{
    EXPECT_EQ(refusal_of(1.3, 1.0), "");
    EXPECT_NE(refusal_of(1.29, 1.0).find("ratio of mesh sizes = 1.29: expected >= 1.3"), std::string::npos) << refusal_of(1.29, 1.0);
    for (const double ratio : {1.0, 0.5, nan}) EXPECT_NE(refusal_of(ratio, 1.0), "") << ratio;
    EXPECT_NE(refusal_of(2.0, 0.0).find("order of convergence = 0: expected > 0"), std::string::npos) << refusal_of(2.0, 0.0);
    EXPECT_NE(refusal_of(2.0, nan), "");
}

}  // namespace
