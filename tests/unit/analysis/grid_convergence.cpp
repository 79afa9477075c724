// Degenerate series, factors, limits of the order used. Reference: the formulas of the header, evaluated by hand. Tolerances: the rounding
// of values, which does not shrink with their differences.
#include "analysis/grid_convergence.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using analysis::GridBehaviour;
using analysis::GridConvergence;
using test_support::rounding_error;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// |f1 - f2| = 0.3, r = 2, p = 1: the limit lies 0.3 beyond the finer and 0.6 beyond the coarser.
TEST(TwoGrids, AreBoundedByThreeTimesTheDistanceFromTheLimit)
{
    const GridConvergence grids = analysis::two_grids({1.0, 1.3}, 2.0, 1.0);
    EXPECT_EQ(grids.behaviour, GridBehaviour::presumed);
    EXPECT_NEAR(grids.extrapolated, 0.7, rounding_error(3, 1.3));
    ASSERT_EQ(grids.bounds.size(), 2u);
    EXPECT_NEAR(grids.bounds[0], 0.9, 3.0 * rounding_error(3 + 2, 1.3));
    EXPECT_NEAR(grids.bounds[1], 1.8, 3.0 * rounding_error(3 + 2, 1.3));
    EXPECT_TRUE(std::isnan(grids.observed_order));
    EXPECT_FALSE(grids.asymptotic);
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

TEST(ThreeGrids, UseNoHigherOrderThanTheFormalOne)
{
    const GridConvergence grids = analysis::three_grids({1.0, 1.1, 1.9}, {2.0, 2.0}, 1.0);  // observed: 3
    // ln (0.8 / 0.1) / ln 2, each difference with the rounding of two values.
    const double of_ratio = rounding_error(2, 1.1) / 0.1 + rounding_error(2, 1.9) / 0.8;
    EXPECT_NEAR(grids.observed_order, 3.0, of_ratio / std::log(2.0) + rounding_error(4, 3.0));
    EXPECT_EQ(grids.order, 1.0);
    const double of_bound = 1.25 * rounding_error(3 + 2, 1.9);
    EXPECT_NEAR(grids.bounds[0], 1.25 * 0.1, of_bound);
    EXPECT_NEAR(grids.bounds[1], 1.25 * 0.2, of_bound);
    EXPECT_NEAR(grids.bounds[2], 1.25 * 1.0, of_bound);
    EXPECT_FALSE(grids.asymptotic);
}

TEST(ThreeGrids, ThatOscillateAreBoundedByThreeTimesTheirRange)
{
    for (const double middle : {0.9, 1.4}) {
        const GridConvergence grids = analysis::three_grids({1.0, middle, 1.2}, {2.0, 2.0}, 2.0);
        EXPECT_EQ(grids.behaviour, GridBehaviour::oscillating);
        EXPECT_EQ(grids.safety_factor, 3.0);
        for (const double bound : grids.bounds) EXPECT_EQ(bound, 3.0 * (std::max(middle, 1.2) - std::min(middle, 1.0)));
    }
}

TEST(ThreeGrids, ThatDoNotChangeHaveNoError)
{
    const GridConvergence grids = analysis::three_grids({4.0, 4.0, 4.0}, {2.0, 1.5}, 2.0);
    EXPECT_EQ(grids.behaviour, GridBehaviour::constant);
    EXPECT_EQ(grids.extrapolated, 4.0);
    for (const double bound : grids.bounds) EXPECT_EQ(bound, 0.0);
}

TEST(ThreeGrids, ThatNoLongerChangeHaveReachedTheirLimit)
{
    const GridConvergence grids = analysis::three_grids({4.0, 4.0, 5.0}, {2.0, 2.0}, 2.0);
    EXPECT_EQ(grids.behaviour, GridBehaviour::monotone);
    EXPECT_EQ(grids.order, 2.0);
    EXPECT_EQ(grids.bounds[0], 0.0);
    EXPECT_EQ(grids.bounds[2], 1.25);
}

TEST(ThreeGrids, ThatChangeOnTheFinestAloneDiverge)
{
    const GridConvergence grids = analysis::three_grids({4.0, 5.0, 5.0}, {2.0, 2.0}, 2.0);
    EXPECT_EQ(grids.behaviour, GridBehaviour::diverging);
    EXPECT_EQ(grids.bounds[0], 3.0);
}

TEST(ThreeGrids, ThatAreNotFiniteAreReportedNotRefused)
{
    for (const double broken : {nan, std::numeric_limits<double>::infinity()}) {
        const GridConvergence grids = analysis::three_grids({1.0, broken, 2.0}, {2.0, 2.0}, 2.0);
        EXPECT_EQ(grids.behaviour, GridBehaviour::not_finite);
        for (const double bound : grids.bounds) EXPECT_TRUE(std::isnan(bound));
    }
    EXPECT_EQ(analysis::two_grids({1.0, nan}, 2.0, 1.0).behaviour, GridBehaviour::not_finite);
}

// The differences 0.2 and 0.3 contain the rounding of 1.2, those of whole numbers none. The order is the root of an equation for log R, R
// the ratio of differences, which goes through ten more roundings and increases with the order at the rate log 1.5 at least; the root is
// found to 1e-13, absolutely and relatively. The bound contains 1 / (1.5^order - 1), and a limit of about 2.6.
TEST(ThreeGrids, DoNotAskForTheUnit)
{
    const GridConvergence metres = analysis::three_grids({1.0, 1.2, 1.5}, {1.5, 1.7}, 2.0);
    const GridConvergence others = analysis::three_grids({-7.0 - 1e6, -7.0 - 1.2e6, -7.0 - 1.5e6}, {1.5, 1.7}, 2.0);
    const double p = metres.observed_order, excess = std::pow(1.5, p) - 1.0;
    const double of_order = rounding_error(1.2 / 0.2 + 1.2 / 0.3 + 2 * 10, 1.0 / std::log(1.5)) + 2.0 * 1e-13 * (1.0 + p);
    const double of_excess = (excess + 1.0) * std::log(1.5) * of_order + rounding_error(2 * 3, 1.0 + excess);
    EXPECT_NEAR(others.observed_order, p, of_order);
    EXPECT_NEAR(others.bounds[1], 1e6 * metres.bounds[1],
                1e6 * (1.25 * 0.2 * of_excess / (excess * excess) + 1.25 * rounding_error(2 * 6, 2.6)));
}

TEST(ObservedOrder, OfRatiosThatHardlyDifferIsThatOfEqualOnes)
{
    const double equal = analysis::observed_order_of_three(3.0, {2.0, 2.0});
    EXPECT_NEAR(equal, std::log2(3.0), rounding_error(3 + 1, equal));
    // The order changes by p / (r ln r) r^p / (r^p - s), 1.7 or 0.9 times as much as this ratio, s the sign of the ratio of differences.
    EXPECT_NEAR(analysis::observed_order_of_three(3.0, {2.0, 2.0 + 1e-9}), equal, 1.8e-9);
    EXPECT_NEAR(analysis::observed_order_of_three(-3.0, {2.0, 2.0 + 1e-9}), equal, 0.9e-9);
}

TEST(ObservedOrder, BeyondWhatCanBeSeenIsInfinite)
{
    EXPECT_EQ(analysis::observed_order_of_three(1e300, {2.0, 1.5}), std::numeric_limits<double>::infinity());
    EXPECT_EQ(analysis::observed_order_of_three(0.0, {2.0, 1.5}), -std::numeric_limits<double>::infinity());
}

TEST(Fields, ThatDoNotChangeHaveNoError)
{
    EXPECT_EQ(analysis::two_fields(0.0, 2.0, 1.0).bounds[1], 0.0);
    EXPECT_TRUE(std::isnan(analysis::two_fields(1.0, 2.0, 1.0).extrapolated));
}

TEST(GridConvergence, RefusesRatiosAndOrdersThatAreNone)
{
    EXPECT_THROW(analysis::two_grids({1.0, 2.0}, 1.0, 1.0), pbs::InputError);
    EXPECT_THROW(analysis::two_grids({1.0, 2.0}, nan, 1.0), pbs::InputError);
    EXPECT_THROW(analysis::two_grids({1.0, 2.0}, 2.0, 0.0), pbs::InputError);
    EXPECT_THROW(analysis::three_grids({1.0, 2.0, 3.0}, {2.0, 0.5}, 1.0), pbs::InputError);
    EXPECT_THROW(analysis::three_grids({1.0, 2.0, 3.0}, {2.0, 2.0}, -1.0), pbs::InputError);
}

}  // namespace
