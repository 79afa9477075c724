// Reference: outcomes that are given step by step.
#include "pbs/solver/step_summary.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using pbs::FrameStep;
using pbs::Outcome;

// Steps that end with these outcomes, each after as many seconds as its number.
FrameStep after(const std::vector<Outcome>& outcomes)
{
    FrameStep frame;
    for (std::size_t step = 0; step < outcomes.size(); ++step) {
        pbs::StepSummary summary;
        summary.outcome = outcomes[step];
        summary.seconds = static_cast<double>(step);
        frame.add(summary, step);
    }
    return frame;
}

TEST(FrameStep, AStepThatFailsBetweenFramesIsTheFramesOutcome)
{
    for (const Outcome failed : {Outcome::not_converged, Outcome::not_finite}) {
        const FrameStep frame = after({Outcome::finished, failed, Outcome::finished, Outcome::finished});
        EXPECT_EQ(frame.summary().outcome, failed);
        EXPECT_EQ(frame.worst_step(), 1u);
    }
}

TEST(FrameStep, TheWorstOfTwoFailuresIsTold)
{
    EXPECT_EQ(after({Outcome::not_converged, Outcome::not_finite}).summary().outcome, Outcome::not_finite);
    EXPECT_EQ(after({Outcome::not_converged, Outcome::not_finite}).worst_step(), 1u);
    EXPECT_EQ(after({Outcome::not_finite, Outcome::not_converged}).summary().outcome, Outcome::not_finite);
    EXPECT_EQ(after({Outcome::not_finite, Outcome::not_converged}).worst_step(), 0u);
    EXPECT_EQ(after({Outcome::not_converged, Outcome::not_converged}).worst_step(), 0u);
}

TEST(FrameStep, OtherwiseItIsTheLastStep)
{
    const FrameStep frame = after({Outcome::finished, Outcome::finished, Outcome::finished});
    EXPECT_EQ(frame.summary().outcome, Outcome::finished);
    EXPECT_EQ(frame.worst_step(), 2u);
    EXPECT_EQ(frame.summary().seconds, 2.0);
    EXPECT_EQ(after({Outcome::not_converged, Outcome::finished}).summary().seconds, 1.0);
}

}  // namespace
