// Factors, fields and refusals. Reference: the formulas of the header, evaluated by hand. Tolerances: the rounding of values, which does
// not shrink with their differences.

#include "analysis/statistics/fits.hpp"
#include "analysis/statistics/grid_convergence.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/refusal.hpp"

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
    EXPECT_EQ(analysis::two_fields(0.3, 2.0, 1.0).bounds[1], 3.0 * 2.0 * 0.3);
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

TEST(TwoGrids, ThatDoNotChangeHaveNoErrorAndBrokenOnesAreReported)
{
    EXPECT_EQ(analysis::two_grids({4.0, 4.0}, 1.5, 2.0).extrapolated, 4.0);
    EXPECT_EQ(analysis::two_grids({4.0, 4.0}, 1.5, 2.0).bounds[1], 0.0);
    EXPECT_EQ(analysis::two_fields(0.0, 2.0, 1.0).bounds[1], 0.0);
    EXPECT_TRUE(std::isnan(analysis::two_fields(1.0, 2.0, 1.0).extrapolated));
    for (const double broken : {nan, std::numeric_limits<double>::infinity()})
        for (const double bound : analysis::two_grids({1.0, broken}, 2.0, 2.0).bounds) EXPECT_FALSE(std::isfinite(bound));
}

TEST(TwoGrids, RefuseMeshesThatAreTooSimilarAndOrdersThatAreNone)
{
    const auto grids = [](double ratio, double order) { return [=] { analysis::two_grids({1.0, 2.0}, ratio, order); }; };
    EXPECT_EQ(test_support::refusal_of(grids(1.3, 1.0)), "accepted");
    test_support::expect_refused("ratio of mesh sizes = 1.29: expected >= 1.3", grids(1.29, 1.0));
    test_support::expect_refused("order of convergence = 0: expected > 0", grids(2.0, 0.0));
    for (const auto& [ratio, order] : {std::pair(1.0, 1.0), {0.5, 1.0}, {nan, 1.0}, {2.0, nan}})
        EXPECT_THROW(grids(ratio, order)(), pbs::InputError) << ratio << " " << order;
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

// By hand: order 1 halves the error, which is then the difference; order 2 quarters it. Richardson's estimate takes the safety factor 1.25,
// and 3 where the order is not credible.
TEST(NestedConvergence, BoundsByRichardsonsEstimateTimesTheSafetyFactor)
{
    const double lowest = std::sqrt(2.0) - 1.0;  // of an order of 1/2
    struct Case {
        const char* name;
        analysis::NestedDistances distances;
        double formal, observed, order;
        bool reliable;
        double difference, bound;
    };
    const std::vector<Case> all = {
        {"order 1", {8.0, 4.0, 0.3}, 2.0, 1.0, 1.0, true, 0.3, 1.25 * 0.3},
        {"order 2", {8.0, 2.0, 0.3}, 2.0, 2.0, 2.0, true, 0.3, 1.25 * 0.1},
        {"twice the difference", {8.0, 2.0, 0.3}, 2.0, 2.0, 2.0, true, 0.6, 1.25 * 0.2},
        {"an order that is too high", {32.0, 1.0, 0.3}, 2.0, 5.0, 2.0, false, 0.3, 3.0 * 0.1},
        {"one that is too low", {1.1, 1.0, 0.3}, 2.0, std::log2(1.1), 0.5, false, 0.3, 3.0 * 0.3 / lowest},
        {"away from the limit", {1.0, 2.0, 0.3}, 2.0, -1.0, 0.5, false, 0.3, 3.0 * 0.3 / lowest},
        // With stiff springs, quadratic elements can be farther from their own refined solution than refined linear ones are.
        {"quadratic elements are no better than refined linear ones", {4.0, 1.0, 2.0}, 2.0, 2.0, 2.0, false, 2.0, 3.0 * 2.0 / 3.0},
        {"no higher order than the formal one", {4.0, 1.0, 0.3}, 1.0, 2.0, 1.0, false, 0.3, 3.0 * 0.3},
        {"the formal one itself", {8.0, 4.0, 0.3}, 1.0, 1.0, 1.0, true, 0.3, 1.25 * 0.3}};
    for (const Case& of : all) {
        SCOPED_TRACE(of.name);
        const auto found = nested_order(of.distances, of.formal);
        EXPECT_DOUBLE_EQ(found.observed, of.observed);
        EXPECT_EQ(found.order, of.order);
        EXPECT_EQ(found.reliable, of.reliable);
        EXPECT_DOUBLE_EQ(found.bound(of.difference), of.bound);
    }
    const auto equal = nested_order({0.0, 0.0, 0.0}, 2.0);
    EXPECT_TRUE(std::isnan(equal.observed));
    EXPECT_FALSE(equal.reliable);
    EXPECT_EQ(equal.bound(0.0), 0.0);
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

TEST(PowerLawEnd, IsWhereTheCostIsAtTheLimitAndMarkedBeyondTheMeasuredSizes)
{
    using Sizes = std::vector<double>;
    for (const auto& [sizes, beyond] : {std::pair(Sizes{1e3, 1e4, 1e5}, false), {{1e5, 1e3, 1e4}, false}, {{1e3, 1e4}, true}}) {
        std::vector<double> ms;
        for (const double vertices : sizes) ms.push_back(total_ms(vertices));
        const PowerLawEnd end = power_law_end(sizes, ms, limit_ms);
        EXPECT_NEAR(end.size, 50e3, end_error());
        EXPECT_NEAR(end.exponent, 1.2, test_support::exponent_error(sizes, ms, 1.2, roundings_of_time));
        EXPECT_EQ(end.beyond, beyond);
    }
    EXPECT_TRUE(power_law_end({1e5, 1e6}, {total_ms(1e5), total_ms(1e6)}, limit_ms).beyond);
}

TEST(PowerLawEnd, WhatDeterminesNoLineIsRefused)
{
    using Values = std::vector<double>;
    const auto message = [](const Values& sizes, const Values& costs) {
        return test_support::refusal_of([&] { power_law_end(sizes, costs, limit_ms); });
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
