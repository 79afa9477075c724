// Reference: the definitions themselves, on invented trajectories for which each outcome and each side of its bound is
// known.
#include "analysis/metrics/stability_outcome.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <type_traits>

namespace {

using namespace analysis;
using Steps = std::vector<StabilityStep>;

constexpr StabilityBounds bounds;
constexpr int disturbed = 10, still = 90;

// Disturbed by this motion per step, and at rest from then on.
Steps calm(double disturbance = 0.1)
{
    Steps steps(disturbed + still);
    for (int i = 0; i < disturbed; ++i) steps[i].motion = disturbance;
    return steps;
}

// The motion of the last third of the still steps grows by `factor` from each of its thirds to the next.
Steps growing(double factor, double from, double disturbance = 0.1)
{
    Steps steps = calm(disturbance);
    const std::size_t begin = steps.size() - still / 3;
    for (std::size_t i = begin; i < steps.size(); ++i)
        steps[i].motion = from * std::pow(factor, double((i - begin) / (still / 9)));
    return steps;
}

TEST(StabilityOutcome, RecoveryCountsTheStillStepsThatWereNotAtRest)
{
    Steps steps = calm();
    EXPECT_EQ(outcome_of(steps, disturbed).outcome, StabilityOutcome::converged);
    EXPECT_EQ(outcome_of(steps, disturbed).recovery_steps, 0);
    for (int i = 0; i < 7; ++i) steps[disturbed + i].motion = 1e-3;
    steps[disturbed + 20].inverted_tets = 1;  // inverted again, after it had been at rest
    EXPECT_EQ(outcome_of(steps, disturbed).outcome, StabilityOutcome::converged);
    EXPECT_EQ(outcome_of(steps, disturbed).recovery_steps, 21);
}

// Every step, or the step `from_end` before the end (1: the last one), has this value.
template <typename Value>
Steps with_all(Value StabilityStep::*member, std::type_identity_t<Value> value, Steps steps = calm())
{
    for (StabilityStep& step : steps) step.*member = value;
    return steps;
}
template <typename Value>
Steps with_one(std::size_t from_end, Value StabilityStep::*member, std::type_identity_t<Value> value)
{
    Steps steps = calm();
    steps[steps.size() - from_end].*member = value;
    return steps;
}

TEST(StabilityOutcome, FollowsFromTheSteps)
{
    using enum StabilityOutcome;
    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    const auto reaches = &StabilityStep::reach;
    const std::vector<std::tuple<const char*, Steps, StabilityOutcome>> all = {
        {"no step", {}, not_finite},
        {"one step that is not finite, whatever follows",
         with_one(still + disturbed - 3, &StabilityStep::finite, false), not_finite},
        {"far away in the last third", with_one(still / 3, reaches, 1.01 * bounds.farthest), diverged},
        {"not so far away in the last third", with_one(still / 3, reaches, 0.99 * bounds.farthest), converged},
        {"far away before the last third", with_one(still / 3 + 1, reaches, 1e9 * bounds.farthest), converged},
        {"a reach beyond all numbers", with_one(1, reaches, infinity), diverged},
        {"a reach that is not a number", with_one(1, reaches, nan), diverged},
        // The bones have moved away and the step was undone: the body is held up and has not diverged.
        {"left behind by steps that were not reached",
         with_all(&StabilityStep::solved, false, with_all(reaches, 2.0 * bounds.farthest)), bounded},
        {"motion that grows beyond the disturbance", growing(1.01 * bounds.growth, 0.1), diverged},
        {"motion that grows less", growing(0.99 * bounds.growth, 0.1), bounded},
        {"motion that grows to less than was put in", growing(2.0, 0.099 / 4), bounded},
        {"motion that grows to more than was put in", growing(2.0, 0.101 / 4), diverged},
        {"motion that grows below rest is rounding", growing(2.0, 0.2 * bounds.rest_motion, 0.0), converged},
        {"a tet inverted in the last step", with_one(1, &StabilityStep::inverted_tets, 1), inverted},
        {"inverted before the end, and not at rest for long enough", with_one(2, &StabilityStep::inverted_tets, 1),
         bounded},
        {"still moving", with_all(&StabilityStep::motion, 1.01 * bounds.rest_motion), bounded},
        {"at rest", with_all(&StabilityStep::motion, 0.99 * bounds.rest_motion), converged},
        {"at rest elsewhere than undisturbed",
         with_all(&StabilityStep::from_undisturbed, 1.01 * bounds.near_undisturbed), bounded},
        {"at rest near the undisturbed", with_all(&StabilityStep::from_undisturbed, 0.99 * bounds.near_undisturbed),
         converged},
        {"a step that was not reached", with_one(bounds.still_steps, &StabilityStep::solved, false), bounded},
        {"a step that was not reached earlier", with_one(bounds.still_steps + 1, &StabilityStep::solved, false),
         converged},
    };
    for (const auto& [name, steps, expected] : all)
        EXPECT_EQ(name_of(outcome_of(steps, disturbed).outcome), name_of(expected)) << name;
    EXPECT_FALSE(outcome_of(with_all(&StabilityStep::motion, 1.01 * bounds.rest_motion), disturbed).recovery_steps);
}

// One tet whose corners all have the sphere of radius 1 about the origin as their place; the diagonal is 2 m.
TEST(StabilityStep, MeasuresInDiagonals)
{
    const pbs::Positions rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, centres = pbs::Positions::Zero(4, 3);
    pbs::Positions after = rest;
    after(1, 0) = 4.0;   // 3 m farther away, so 3 m from its place
    after(3, 2) = -1.0;  // inverted
    const Eigen::VectorXd distance = Eigen::VectorXd::Ones(4);
    const pbs::Tets tets{{0, 1, 2, 3}};
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
    const std::string written = criteria_text(
        {.farthest = 7.25, .growth = 1.75, .rest_motion = 3e-4, .near_undisturbed = 2e-2, .still_steps = 17});
    for (const char* bound : {"7.25", "1.75", "0.0003", "0.02", "17 steps"})
        EXPECT_NE(written.find(bound), std::string::npos) << bound;
    for (const auto outcome : {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
                               StabilityOutcome::diverged, StabilityOutcome::not_finite})
        EXPECT_NE(written.find("| " + name_of(outcome) + " |"), std::string::npos);
}

}  // namespace
