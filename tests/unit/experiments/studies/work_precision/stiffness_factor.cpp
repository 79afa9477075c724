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

TEST(NearestFactor, ExtendsTheGridUntilTheMinimumIsBracketed)
{
    for (const double exact : {200.0, 1000.0, 0.01, 0.001}) {
        const StiffnessFactor found = nearest_factor([&](double factor) { return 5.0 + std::abs(std::log2(factor / exact)); });
        EXPECT_EQ(found.outcome, ThetaOutcome::found) << exact;
        EXPECT_LT(std::abs(std::log2(found.theta.value() / exact)), octaves) << exact;
        EXPECT_LT(found.lowest_tried, exact);
        EXPECT_GT(found.highest_tried, exact);
    }
}

TEST(NearestFactor, StatesThatThereIsNoMinimumInside)
{
    const auto stiffer_is_nearer = [](double factor) { return 100.0 / factor; };
    const StiffnessFactor stiff = nearest_factor(stiffer_is_nearer), soft = nearest_factor([](double factor) { return 100.0 * factor; });
    for (const StiffnessFactor& found : {stiff, soft}) {
        EXPECT_EQ(found.outcome, ThetaOutcome::end_of_grid);
        EXPECT_FALSE(found.theta);
        EXPECT_EQ(found.error_at_1_pct, 100.0);
    }
    EXPECT_EQ(stiff.highest_tried, 4096.0);
    EXPECT_EQ(stiff.error_pct, 100.0 / 4096.0);
    EXPECT_EQ(soft.lowest_tried, 1.0 / 4096.0);
}

TEST(NearestFactor, IsNotAboveTheLargestStiffnessThatTheDeformerAccepts)
{
    for (const double highest : {1.0, 5.0, 100.0}) {
        const StiffnessFactor found = nearest_factor([](double factor) { return 100.0 / factor; }, highest);
        EXPECT_EQ(found.outcome, ThetaOutcome::highest_allowed);
        EXPECT_EQ(found.highest_tried, std::exp2(std::log2(highest)));
        EXPECT_FALSE(found.theta);
    }
    const StiffnessFactor inside = nearest_factor([](double factor) { return 5.0 + std::abs(std::log2(factor)); }, 5.0);
    EXPECT_EQ(inside.outcome, ThetaOutcome::found);
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
