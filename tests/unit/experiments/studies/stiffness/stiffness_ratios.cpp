// What is no stiffness. Reference: the rule. The kept records check ratios and exponents
// (tests/regression/experiments/kept_values.cpp).
#include "experiments/studies/stiffness/stiffness_ratios.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stiffness_ratios_tests {
namespace {

using namespace experiments;

// Stiffnesses that grow with the square of the iterations: the ratio of a doubling is 4.
std::vector<StiffnessRow> squares()
{
    std::vector<StiffnessRow> rows;
    for (const int n : {3, 6, 12, 24, 48, 96}) {
        StiffnessRow& row = rows.emplace_back();
        row.body = "limb";
        row.load = "zone";
        row.vertices = 600;
        row.setting.iterations = n;
        row.stiffness_n_m = 7.0 * n * n;
        row.converged = true;
    }
    return rows;
}

TEST(StiffnessRatios, LeavesOutWhatDidNotConvergeOrHangsUpwards)
{
    std::vector<StiffnessRow> rows = squares();
    rows[3].converged = false;
    rows[3].stiffness_n_m = 1e6;
    rows[5].stiffness_n_m = -1.0;
    // The exponent, log 2 / log(x ratio), goes through five roundings, the power through two and the stiffness ratio
    // through one.
    EXPECT_NEAR(stiffness_ratios(rows, Varied::iterations).at(0).high, 4.0,
                test_support::rounding_error(5.0 * std::log(4.0) + 2.0 + 1.0, 4.0));
    EXPECT_EQ(stiffness_exponents(rows, Varied::iterations).integer(0, "left_out"), 2);
    for (StiffnessRow& all : rows) all.converged = false;
    EXPECT_TRUE(stiffness_ratios(rows, Varied::iterations).empty());
    EXPECT_EQ(stiffness_exponents(rows, Varied::iterations).rows(), 0);
}

}  // namespace
}  // namespace stiffness_ratios_tests
