// Reference: errors with a known minimum. The bracket of two octaves is narrowed six times to a share of 0.618, and the best of its inner
// points is at most 0.618 of it away from the minimum: 2 * 0.618^7 octaves.
#include "experiments/studies/work_precision/stiffness_factor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

constexpr double octaves = 0.0689;  // 2 * 0.618034^7, rounded upwards

TEST(NearestFactor, FindsAMinimumBetweenTheFactorsOfTheGrid)
{
    for (const double exact : {3.7, 0.3, 1.0, 40.0}) {
        const StiffnessFactor found = nearest_factor([&](double factor) { return 5.0 + std::abs(std::log2(factor / exact)); });
        EXPECT_EQ(found.outcome, ThetaOutcome::found);
        EXPECT_LT(std::abs(std::log2(found.theta.value() / exact)), octaves) << exact;
        EXPECT_LT(found.error_pct.value(), 5.0 + octaves);
        EXPECT_EQ(found.error_at_1_pct.value(), 5.0 + std::abs(std::log2(1.0 / exact)));
        EXPECT_EQ(found.tried, 11 + 8);
    }
}

TEST(NearestFactor, StatesThatItIsAtTheEndOfTheGrid)
{
    const auto stiffer_is_nearer = [](double factor) { return 100.0 / factor; };
    EXPECT_EQ(nearest_factor(stiffer_is_nearer).outcome, ThetaOutcome::end_of_grid);
    EXPECT_EQ(nearest_factor(stiffer_is_nearer).theta, 64.0);
    EXPECT_EQ(nearest_factor(stiffer_is_nearer, 5.0).theta, std::exp2(std::log2(5.0))) << "no factor is above the highest one";
    EXPECT_EQ(nearest_factor([](double factor) { return 100.0 * factor; }).theta, 1.0 / 16.0);
}

TEST(NearestFactor, StatesThatTheStiffnessHasNoEffect)
{
    const StiffnessFactor found = nearest_factor([](double factor) { return 8.0 + 0.005 * std::log2(factor); });
    EXPECT_EQ(found.outcome, ThetaOutcome::insensitive);
    EXPECT_FALSE(found.theta);
    EXPECT_EQ(found.error_at_1_pct, 8.0);
}

TEST(NearestFactor, PassesOverFactorsWithoutAnAnswer)
{
    const auto below_3 = [](double factor) { return factor < 3.0 ? std::optional(10.0 - factor) : std::nullopt; };
    const StiffnessFactor found = nearest_factor(below_3);
    EXPECT_EQ(found.outcome, ThetaOutcome::found);
    EXPECT_GE(found.theta.value(), 2.0);
    EXPECT_LT(found.theta.value(), 3.0);
    EXPECT_EQ(nearest_factor([](double) { return std::optional<double>(); }).outcome, ThetaOutcome::not_finite);
}

}  // namespace
