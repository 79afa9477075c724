// Reference: outcomes that are given step by step.
#include "pbs/solver/step_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

// The worst outcome of all and the first step that has it; the seconds of the last step.
TEST(FrameStep, HasTheWorstOutcomeOfItsSteps)
{
    using enum Outcome;
    struct Case {
        std::vector<Outcome> steps;
        Outcome outcome;
        std::size_t worst_step;
    };
    for (const auto& [steps, outcome, worst_step] :
         {Case{{finished, not_converged, finished, finished}, not_converged, 1},
          Case{{finished, not_finite, finished, finished}, not_finite, 1},
          Case{{not_converged, not_finite}, not_finite, 1}, Case{{not_finite, not_converged}, not_finite, 0},
          Case{{not_converged, not_converged}, not_converged, 0}, Case{{not_converged, finished}, not_converged, 0},
          Case{{finished, finished, finished}, finished, 2}}) {
        const FrameStep frame = after(steps);
        EXPECT_EQ(frame.summary().outcome, outcome);
        EXPECT_EQ(frame.worst_step(), worst_step);
        EXPECT_EQ(frame.summary().seconds, double(steps.size() - 1));
    }
}

// Reference: root mean squares by hand.

using pbs::Residuals;
using pbs::Vec3;

TEST(Residuals, AreRootMeanSquares)
{
    pbs::ConstraintSet<double> constraints;
    constraints.stretch = {{{0, 1}, 1.0, 1.0}, {{0, 2}, 4.0, 1.0}};  // l / l0 - 1: 1, -0.5
    constraints.volume = {{{0, 1, 2, 3}, 1.0, 1.0}};                 // V / V0 - 1: 1
    constraints.bind = {{1, 1.0, 1.0}, {2, 5.0, 1.0}};               // |p - q| - d: 1, -3 m
    const std::vector<Vec3> p = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)};
    const std::vector<Vec3> q(4, Vec3::Zero());
    const Residuals residuals = pbs::residuals_of(constraints, p, q);
    EXPECT_DOUBLE_EQ(residuals.stretch_rms, std::sqrt(1.25 / 2.0));
    EXPECT_DOUBLE_EQ(residuals.volume_rms, 1.0);
    EXPECT_DOUBLE_EQ(residuals.bind_rms_m, std::sqrt(5.0));
    EXPECT_EQ(pbs::largest(residuals), residuals.bind_rms_m);
}

TEST(Residuals, OfNoConstraintsAreZero)
{
    const Residuals residuals = pbs::residuals_of<float>({}, {}, {});
    EXPECT_EQ(pbs::largest(residuals), 0.0);
}

TEST(Residuals, LargestIsNotANumberWhereOneIsNot)
{
    const double nan = std::nan("");
    EXPECT_TRUE(std::isnan(pbs::largest({nan, 1.0, 2.0})));
    EXPECT_TRUE(std::isnan(pbs::largest({1.0, nan, 2.0})));
    EXPECT_TRUE(std::isnan(pbs::largest({1.0, 2.0, nan})));
}

}  // namespace
