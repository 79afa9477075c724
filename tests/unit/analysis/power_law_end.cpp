// Expected values follow from timings that are a power of the size.
#include "analysis/power_law_end.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/fit_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace {

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
