// Factors, fields and refusals. Reference: the formulas of the header, evaluated by hand. Tolerances: the rounding of values, which does
// not shrink with their differences.

#include "analysis/statistics/fits.hpp"
#include "analysis/statistics/grid_convergence.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/fit_rounding.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <tuple>

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

// Reference: distances and fields made by hand as C h^p, whose order and error are known.

using analysis::nested_order;

constexpr int few_roundings = 16;  // of a logarithm, a power and a quotient, on both sides

TEST(NestedConvergence, TakesTheOrderOfTheLinearSolutions)
{
    for (const double order : {0.5, 1.0, 1.7, 2.0}) {
        const auto found = nested_order({3.0 * std::exp2(order), 3.0, 0.7}, 2.0);
        EXPECT_NEAR(found.observed, order, test_support::rounding_error(few_roundings, order));
        EXPECT_EQ(found.order, found.observed);
        EXPECT_TRUE(found.reliable || order == 0.5);  // at the limit rounding decides
    }
}

// By hand: order 1 halves the error, which is then the difference; order 2 quarters it.
TEST(NestedConvergence, BoundsByRichardsonsEstimateTimesTheSafetyFactor)
{
    EXPECT_DOUBLE_EQ(nested_order({8.0, 4.0, 0.3}, 2.0).bound(0.3), 1.25 * 0.3);
    EXPECT_DOUBLE_EQ(nested_order({8.0, 2.0, 0.3}, 2.0).bound(0.3), 1.25 * 0.1);
    EXPECT_DOUBLE_EQ(nested_order({8.0, 2.0, 0.3}, 2.0).bound(0.6), 1.25 * 0.2);
}

TEST(NestedConvergence, AnOrderThatIsNotCredibleTakesTheLargerFactor)
{
    const auto high = nested_order({32.0, 1.0, 0.3}, 2.0), low = nested_order({1.1, 1.0, 0.3}, 2.0),
               away = nested_order({1.0, 2.0, 0.3}, 2.0);
    EXPECT_DOUBLE_EQ(high.observed, 5.0);
    EXPECT_EQ(high.order, 2.0);
    EXPECT_DOUBLE_EQ(high.bound(0.3), 3.0 * 0.1);
    for (const auto& found : {low, away}) {
        EXPECT_EQ(found.order, 0.5);
        EXPECT_DOUBLE_EQ(found.bound(0.3), 3.0 * 0.3 / (std::sqrt(2.0) - 1.0));
    }
    EXPECT_DOUBLE_EQ(away.observed, -1.0);
    for (const auto& found : {high, low, away}) EXPECT_FALSE(found.reliable);
}

// With stiff springs, quadratic elements can be farther from their own refined solution than refined linear ones are.
TEST(NestedConvergence, IsNotReliableWhereQuadraticElementsAreNoBetterThanRefinedLinearOnes)
{
    const auto found = nested_order({4.0, 1.0, 2.0}, 2.0);
    EXPECT_EQ(found.order, 2.0);
    EXPECT_FALSE(found.reliable);
    EXPECT_DOUBLE_EQ(found.bound(2.0), 3.0 * 2.0 / 3.0);
}

TEST(NestedConvergence, OfEqualSolutionsIsNoOrderAndNoError)
{
    const auto found = nested_order({0.0, 0.0, 0.0}, 2.0);
    EXPECT_TRUE(std::isnan(found.observed));
    EXPECT_FALSE(found.reliable);
    EXPECT_EQ(found.bound(0.0), 0.0);
}

TEST(NestedConvergence, UsesNoHigherOrderThanTheFormalOne)
{
    EXPECT_EQ(nested_order({4.0, 1.0, 0.3}, 1.0).order, 1.0);
    EXPECT_FALSE(nested_order({4.0, 1.0, 0.3}, 1.0).reliable);
    EXPECT_TRUE(nested_order({8.0, 4.0, 0.3}, 1.0).reliable);
}

// By hand: the linear solutions are 8 and 4 from the quadratic one, which is order 1, and 5 from each other. The refined linear one is then
// at most 3 * 5 from the limit.
TEST(NestedConvergence, WithoutTheFinestSolutionIsNeverReliable)
{
    const auto found = analysis::order_without_finest(8.0, 4.0, 2.0);
    EXPECT_DOUBLE_EQ(found.observed, 1.0);
    EXPECT_FALSE(found.reliable);
    EXPECT_DOUBLE_EQ(found.bound(5.0), 15.0);
    EXPECT_EQ(analysis::order_without_finest(8.0, 1.0, 2.0).order, 2.0) << "not above the formal order";
}

// x_0 + e h^p on h = 1 and 2.
TEST(NestedConvergence, ExtrapolatesToTheLimit)
{
    const pbs::Positions limit = pbs::Positions::Random(20, 3), error = pbs::Positions::Random(20, 3);
    for (const double order : {1.0, 3.0}) {
        const pbs::Positions found = analysis::extrapolated(limit + error, limit + std::exp2(order) * error, order);
        EXPECT_LT((found - limit).cwiseAbs().maxCoeff(), test_support::rounding_error(6, 16.0)) << order;
    }
}

// Expected values follow from timings that are a power of the size.

using namespace analysis;

constexpr double limit_ms = 1e3 / 30.0;

// total = c V^1.2 is 1000 / 30 ms at 50,000 vertices. A time goes through six roundings: two quotients and a product, the power, and that
// of V over 50,000 by the power.
constexpr double roundings_of_time = 6.0;

double total_ms(double vertices)
{
    return limit_ms * std::pow(vertices / 50e3, 1.2);
}

// V (real time / time)^(1 / slope) from V at least 1e3 on, between two sizes of ratio 10. The ratio of two times is in error by 13
// roundings, and so is its logarithm, which is above 2, as is that of the sizes; the logarithms and their quotients go through six of their
// own. The power goes through two, a product through one, and the ratio to real time through another and those of the time.
double end_error()
{
    const double of_slope = test_support::rounding_error((2.0 * roundings_of_time + 1.0) / 2.0 + 1.0 / 2.0 + 6.0, 1.0);
    return 50e3 * (std::log(50e3 / 1e3) * of_slope + test_support::rounding_error(roundings_of_time + 1.0 + 2.0 + 1.0, 1.0));
}

TEST(PowerLawEnd, IsWhereTheCostIsAtTheLimit)
{
    for (const std::vector<double>& sizes : {std::vector<double>{1e3, 1e4, 1e5}, {1e5, 1e3, 1e4}}) {
        std::vector<double> ms;
        for (const double vertices : sizes) ms.push_back(total_ms(vertices));
        const PowerLawEnd end = power_law_end(sizes, ms, limit_ms);
        EXPECT_NEAR(end.size, 50e3, end_error());
        EXPECT_NEAR(end.exponent, 1.2, test_support::exponent_error(sizes, ms, 1.2, roundings_of_time));
        EXPECT_FALSE(end.beyond);
    }
}

TEST(PowerLawEnd, BeyondTheMeasuredSizesIsMarked)
{
    const PowerLawEnd above = power_law_end({1e3, 1e4}, {total_ms(1e3), total_ms(1e4)}, limit_ms);
    EXPECT_NEAR(above.size, 50e3, end_error());
    EXPECT_TRUE(above.beyond);
    EXPECT_TRUE(power_law_end({1e5, 1e6}, {total_ms(1e5), total_ms(1e6)}, limit_ms).beyond);
}

TEST(PowerLawEnd, WhatDeterminesNoLineIsRefused)
{
    using Values = std::vector<double>;
    const auto message = [](const Values& sizes, const Values& costs) -> std::string {
        try {
            power_law_end(sizes, costs, limit_ms);
        } catch (const pbs::InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_EQ(message({1e3, 1e4}, {1.0, 2.0}), "accepted");
    for (const auto& [sizes, costs, part] :
         std::vector<std::tuple<Values, Values, std::string>>{{{}, {}, "sizes = 0: expected two or more"},
                                                              {{1e3}, {1.0}, "sizes = 1: expected two or more"},
                                                              {{1e3, 1e4}, {1.0}, "costs = 1: expected as many as sizes"},
                                                              {{1e3, 1e4}, {1.0, 2.0, 3.0}, "costs = 3: expected as many as sizes"},
                                                              {{1e3, 1e4, 1e3}, {1.0, 2.0, 3.0}, "sizes = 1000: expected different sizes"},
                                                              {{0.0, 1e4}, {1.0, 2.0}, "sizes = 0: expected sizes above 0"},
                                                              {{1e3, 1e4}, {-1.0, 2.0}, "costs = -1: expected costs above 0"},
                                                              {{1e3, 1e4}, {1.0, std::nan("")}, "costs = nan: expected costs above 0"},
                                                              {{1e3, 1e4}, {2.0, 2.0}, "costs = 2: expected different costs"},
                                                              {{1e3, 1e4, 1e5}, {1.0, 2.0, 2.0}, "costs = 2: expected different costs"}})
        EXPECT_NE(message(sizes, costs).find(part), std::string::npos) << message(sizes, costs);
}

}  // namespace
