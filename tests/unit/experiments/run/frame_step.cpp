// Reference: the outcomes prescribed for a deformer, step by step.
#include "experiments/deformers/deformer.hpp"
#include "experiments/run/frame_step.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using experiments::FrameStep;
using pbs::Outcome;

// Its steps end as prescribed, each after as many seconds as its number.
class FailingDeformer : public experiments::Deformer {
public:
    explicit FailingDeformer(std::vector<Outcome> outcomes) : outcomes_(std::move(outcomes)) {}

    void reset(const pbs::Character&) override {}
    pbs::StepSummary advance(const pbs::Pose&, double) override
    {
        pbs::StepSummary summary;
        summary.outcome = outcomes_.at(steps_);
        summary.seconds = static_cast<double>(steps_++);
        return summary;
    }
    const pbs::Positions& positions() const override { return positions_; }
    bool has_memory() const override { return true; }

private:
    std::vector<Outcome> outcomes_;
    std::size_t steps_ = 0;
    pbs::Positions positions_;
};

FrameStep after(const std::vector<Outcome>& outcomes)
{
    FailingDeformer deformer(outcomes);
    FrameStep frame;
    for (std::size_t step = 0; step < outcomes.size(); ++step) frame.add(deformer.advance({}, 0.01), step);
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
