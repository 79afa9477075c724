#include "analysis/statistics/fits.hpp"
#include "analysis/statistics/grid_convergence.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rounding_error.hpp"

#include <cmath>
#include <tuple>
#include <vector>

namespace {

// Reference: distances and fields made by hand as C h^p, whose order and error are known.

using analysis::nested_order;

constexpr int few_roundings = 16;  // of a logarithm, a power and a quotient, on both sides

TEST(NestedConvergence, TakesTheOrderOfTheLinearSolutions)
{
    for (const double order : {0.5, 1.0, 1.7, 2.0}) {
        const auto found = nested_order({3.0 * std::exp2(order), 3.0, 0.7}, 2.0);
        EXPECT_NEAR(found.observed, order, test_support::rounding_error(few_roundings, order));
        EXPECT_EQ(found.order, found.observed);
        EXPECT_EQ(found.reliable, order > 0.95);
    }
}

// By hand: order 1 halves the error, which is then the difference; order 2 quarters it. Richardson's estimate takes the
// safety factor 1.25, and 3 where the order is not credible.
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
        // With stiff springs, quadratic elements can be farther from their own refined solution than refined linear
        // ones are.
        {"quadratic elements are no better than refined linear ones",
         {4.0, 1.0, 2.0},
         2.0,
         2.0,
         2.0,
         false,
         2.0,
         3.0 * 2.0 / 3.0},
        {"quadratic elements are closer, but not twice as close",
         {4.0, 1.0, 0.6},
         2.0,
         2.0,
         2.0,
         false,
         0.6,
         3.0 * 0.6 / 3.0},
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

// Expected values follow from timings that are a power of the size.

using namespace analysis;

constexpr double limit_ms = 1e3 / 30.0;

// total = c V^1.2 is 1000 / 30 ms at 50,000 vertices. A time goes through six roundings: two quotients and a product,
// the power, and that of V over 50,000 by the power.
constexpr double roundings_of_time = 6.0;

double total_ms(double vertices)
{
    return limit_ms * std::pow(vertices / 50e3, 1.2);
}

// V (real time / time)^(1 / slope) from V at least 1e3 on, between two sizes of ratio 10. The ratio of two times is in
// error by 13 roundings, and so is its logarithm, which is above 2, as is that of the sizes; the logarithms and their
// quotients go through six of their own. The power goes through two, a product through one, and the ratio to real time
// through another and those of the time.
double end_error()
{
    const double of_slope = test_support::rounding_error((2.0 * roundings_of_time + 1.0) / 2.0 + 1.0 / 2.0 + 6.0, 1.0);
    return 50e3 *
           (std::log(50e3 / 1e3) * of_slope + test_support::rounding_error(roundings_of_time + 1.0 + 2.0 + 1.0, 1.0));
}

TEST(PowerLawEnd, IsWhereTheCostIsAtTheLimitAndMarkedBeyondTheMeasuredSizes)
{
    using Sizes = std::vector<double>;
    for (const auto& [sizes, beyond] :
         {std::pair(Sizes{1e3, 1e4, 1e5}, false), {{1e5, 1e3, 1e4}, false}, {{1e3, 1e4}, true}}) {
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
    for (const auto& [sizes, costs, part] : std::vector<std::tuple<Values, Values, std::string>>{
             {{}, {}, "sizes = 0: expected two or more"},
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
