// Sleep: constraints that LBS satisfies, and whose neighbours it satisfies too, are left out of the frame. Reference: the same solver
// without sleep.
#include "pbs/solver/pbs_solver.hpp"

#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double bar_edge = 0.1;
const TetMesh bar = test_support::structured_bar({0, 0, 0}, {4.0, 0.3, 0.3}, {40, 3, 3});

PbsOptions options_of(Order order, bool sleep)
{
    PbsOptions options;
    options.order = order;
    options.precision = Precision::f64;
    options.k_bind = 0.0;  // without a constraint that holds them, disturbances at one end travel
    options.sleep = sleep;
    return options;
}

struct Step {
    Positions positions;
    StepSummary summary;
};

Step step_from(const Positions& lbs, const PbsOptions& options)
{
    PbsSolver solver(bar, Eigen::VectorXd::Zero(bar.rest.rows()), {}, options);
    Step step;
    step.summary = solver.advance(lbs, lbs, 0.01);
    step.positions = solver.positions();
    return step;
}

// The last layer, displaced from the rest.
Positions pulled(double metres)
{
    Positions lbs = bar.rest;
    for (Eigen::Index i = 0; i < lbs.rows(); ++i)
        if (lbs(i, 0) > 3.95) lbs(i, 0) += metres;
    return lbs;
}

double largest_distance(const Positions& a, const Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

class Sleep : public testing::TestWithParam<Order> {};

TEST_P(Sleep, EverythingSleepsWhereEverythingIsSatisfied)
{
    const Positions moved = bar.rest.rowwise() + Eigen::RowVector3d(1.0, 2.0, 3.0);
    const Step step = step_from(moved, options_of(GetParam(), true));
    EXPECT_EQ(step.summary.sleeping_share, 1.0);
    EXPECT_EQ(step.summary.wakings, 0);
    EXPECT_EQ(step.positions, moved);
}

// Within 24 iterations, the displacement reaches farther than the three rings that are kept awake around the disturbance.
TEST_P(Sleep, AFrameIsRedoneWhereASleepingRegionIsDisturbed)
{
    const Positions lbs = pulled(0.1);
    const Step asleep = step_from(lbs, options_of(GetParam(), true)), awake = step_from(lbs, options_of(GetParam(), false));
    EXPECT_GE(asleep.summary.wakings, 1);
    EXPECT_GT(asleep.summary.sleeping_share, 0.1);  // and the far end still sleeps
    EXPECT_EQ(awake.summary.wakings, 0);
    EXPECT_EQ(awake.summary.sleeping_share, 0.0);
    // A constraint that was left out would have corrected at most its error, below the tolerance times its edge, in each iteration.
    const double tolerance = PbsOptions{}.sleep_tolerance;
    EXPECT_LT(largest_distance(asleep.positions, awake.positions), 24 * tolerance * bar_edge);
}

TEST_P(Sleep, WithoutToleranceNothingThatIsOffSleeps)
{
    PbsOptions options = options_of(GetParam(), true);
    options.sleep_tolerance = 0.0;
    const Positions lbs = 1.01 * bar.rest;
    const Step asleep = step_from(lbs, options), awake = step_from(lbs, options_of(GetParam(), false));
    EXPECT_LT(asleep.summary.sleeping_share, 0.02);  // only empty batches: pauses at the end of a class, some five of four hundred
    EXPECT_EQ(asleep.positions, awake.positions);
}

INSTANTIATE_TEST_SUITE_P(Orders, Sleep, testing::Values(Order::ordered, Order::grouped),
                         [](const auto& order) { return order.param == Order::ordered ? "ordered" : "grouped"; });

}  // namespace
