// Reference: the definitions themselves, on invented trajectories for which each outcome and each side of its bound is known.
#include "analysis/metrics/stability_outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace analysis;
using Steps = std::vector<StabilityStep>;

constexpr StabilityBounds bounds;
constexpr int disturbed = 10, still = 90;

// Disturbed by a motion of 0.1 per step, and at rest from then on.
Steps calm()
{
    Steps steps(disturbed + still);
    for (int i = 0; i < disturbed; ++i) steps[i].motion = 0.1;
    return steps;
}

StabilityOutcome outcome(const Steps& steps)
{
    return outcome_of(steps, disturbed).outcome;
}

// The motion of the last third of the still steps grows by `factor` from each of its thirds to the next.
Steps growing(double factor, double from)
{
    Steps steps = calm();
    const std::size_t begin = steps.size() - still / 3;
    for (std::size_t i = begin; i < steps.size(); ++i) steps[i].motion = from * std::pow(factor, double((i - begin) / (still / 9)));
    return steps;
}

TEST(StabilityOutcome, RestIsConverged)
{
    const StabilityResult result = outcome_of(calm(), disturbed);
    EXPECT_EQ(result.outcome, StabilityOutcome::converged);
    EXPECT_EQ(result.recovery_steps, 0);
}

TEST(StabilityOutcome, RecoveryCountsTheStillStepsThatWereNotAtRest)
{
    Steps steps = calm();
    for (int i = 0; i < 7; ++i) steps[disturbed + i].motion = 1e-3;
    steps[disturbed + 20].inverted_tets = 1;  // inverted again, after it had been at rest
    const StabilityResult result = outcome_of(steps, disturbed);
    EXPECT_EQ(result.outcome, StabilityOutcome::converged);
    EXPECT_EQ(result.recovery_steps, 21);
}

TEST(StabilityOutcome, OneStepThatIsNotFiniteIsNotFiniteWhateverFollows)
{
    Steps steps = calm();
    steps[3].finite = false;
    EXPECT_EQ(outcome(steps), StabilityOutcome::not_finite);
    EXPECT_EQ(outcome({}), StabilityOutcome::not_finite);
}

TEST(StabilityOutcome, FarAwayInTheLastThirdIsDiverged)
{
    Steps steps = calm();
    steps[steps.size() - still / 3].reach = 1.01 * bounds.farthest;
    EXPECT_EQ(outcome(steps), StabilityOutcome::diverged);
    steps[steps.size() - still / 3].reach = 0.99 * bounds.farthest;
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

TEST(StabilityOutcome, FarAwayBeforeTheLastThirdIsForgiven)
{
    Steps steps = calm();
    steps[steps.size() - still / 3 - 1].reach = 1e9;
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

// The bones have moved away and the step was undone: the body is held up and has not diverged.
TEST(StabilityOutcome, LeftBehindByAStepThatWasNotReachedIsBounded)
{
    Steps steps = calm();
    for (auto& step : steps) {
        step.reach = 2.0 * bounds.farthest;
        step.solved = false;
    }
    EXPECT_EQ(outcome(steps), StabilityOutcome::bounded);
}

TEST(StabilityOutcome, AReachBeyondAllNumbersIsDiverged)
{
    for (const double reach : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        Steps steps = calm();
        steps.back().reach = reach;
        EXPECT_EQ(outcome(steps), StabilityOutcome::diverged);
    }
}

TEST(StabilityOutcome, MotionThatGrowsBeyondTheDisturbanceIsDiverged)
{
    EXPECT_EQ(outcome(growing(1.01 * bounds.growth, 0.1)), StabilityOutcome::diverged);
    EXPECT_EQ(outcome(growing(0.99 * bounds.growth, 0.1)), StabilityOutcome::bounded);
}

TEST(StabilityOutcome, MotionThatGrowsToLessThanWasPutInIsNot)
{
    EXPECT_EQ(outcome(growing(2.0, 0.099 / 4)), StabilityOutcome::bounded);
    EXPECT_EQ(outcome(growing(2.0, 0.101 / 4)), StabilityOutcome::diverged);
}

TEST(StabilityOutcome, MotionThatGrowsBelowRestIsRounding)
{
    Steps steps = growing(2.0, 0.2 * bounds.rest_motion);
    for (int i = 0; i < disturbed; ++i) steps[i].motion = 0.0;
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

TEST(StabilityOutcome, ATetInvertedInTheLastStepIsInverted)
{
    Steps steps = calm();
    steps.back().inverted_tets = 1;
    EXPECT_EQ(outcome(steps), StabilityOutcome::inverted);
    std::swap(steps.back(), steps[steps.size() - 2]);
    EXPECT_EQ(outcome(steps), StabilityOutcome::bounded);  // not inverted at the end, and not at rest for long enough
}

TEST(StabilityOutcome, WhatStillMovesIsBounded)
{
    Steps steps = calm();
    for (auto& step : steps) step.motion = 1.01 * bounds.rest_motion;
    EXPECT_EQ(outcome(steps), StabilityOutcome::bounded);
    EXPECT_FALSE(outcome_of(steps, disturbed).recovery_steps);
    for (auto& step : steps) step.motion = 0.99 * bounds.rest_motion;
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

TEST(StabilityOutcome, RestElsewhereThanUndisturbedIsBounded)
{
    Steps steps = calm();
    for (auto& step : steps) step.from_undisturbed = 1.01 * bounds.near_undisturbed;
    EXPECT_EQ(outcome(steps), StabilityOutcome::bounded);
    for (auto& step : steps) step.from_undisturbed = 0.99 * bounds.near_undisturbed;
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

TEST(StabilityOutcome, AStepThatWasNotReachedIsNeverConverged)
{
    Steps steps = calm();
    steps[steps.size() - bounds.still_steps].solved = false;
    EXPECT_EQ(outcome(steps), StabilityOutcome::bounded);
    std::swap(steps[steps.size() - bounds.still_steps], steps[steps.size() - bounds.still_steps - 1]);
    EXPECT_EQ(outcome(steps), StabilityOutcome::converged);
}

// One tet whose corners all have the sphere of radius 1 about the origin as their place; the diagonal is 2 m.
TEST(StabilityStep, MeasuresInDiagonals)
{
    pbs::Positions rest(4, 3), after(4, 3);
    rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    after = rest;
    after(1, 0) = 4.0;   // 3 m farther away, so 3 m from its place
    after(3, 2) = -1.0;  // inverted
    const pbs::Positions centres = pbs::Positions::Zero(4, 3);
    const Eigen::VectorXd distance = Eigen::VectorXd::Ones(4);
    const pbs::Tets tets = (pbs::Tets(1, 4) << 0, 1, 2, 3).finished();
    const StabilityStep step = stability_step(rest, after, {centres, distance}, tets, 2.0, &rest);
    EXPECT_TRUE(step.finite);
    EXPECT_DOUBLE_EQ(step.motion, 1.5);
    EXPECT_DOUBLE_EQ(step.reach, 1.5);
    EXPECT_DOUBLE_EQ(step.from_undisturbed, 1.5);
    EXPECT_EQ(step.inverted_tets, 1);
    EXPECT_TRUE(std::isnan(stability_step(rest, after, {centres, distance}, tets, 2.0).from_undisturbed));
    after(2, 2) = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(stability_step(rest, after, {centres, distance}, tets, 2.0).finite);
}

TEST(StabilityOutcome, TheWrittenCriteriaCarryTheBoundsThatAreApplied)
{
    const std::string written =
        criteria_text({.farthest = 7.25, .growth = 1.75, .rest_motion = 3e-4, .near_undisturbed = 2e-2, .still_steps = 17});
    for (const char* bound : {"7.25", "1.75", "0.0003", "0.02", "17 steps"}) EXPECT_NE(written.find(bound), std::string::npos) << bound;
    for (const auto outcome : {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
                               StabilityOutcome::diverged, StabilityOutcome::not_finite})
        EXPECT_NE(written.find("| " + name_of(outcome) + " |"), std::string::npos);
}

}  // namespace
