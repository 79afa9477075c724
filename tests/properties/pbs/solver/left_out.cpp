// Nothing is built that a scene does not need, and nothing is projected that sleeps. Reference: this requirement,
// checked in the solver's own parts for every combination of classes with and without stiffness.
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace left_out_tests {
namespace {

using namespace pbs;

const TetMesh bar = test_support::structured_bar({0, 0, 0}, {3, 1, 1}, {6, 2, 2});
const Eigen::VectorXd distance = Eigen::VectorXd::LinSpaced(bar.rest.rows(), 0.1, 0.5);

// Bit 0: stretch, 1: volume, 2: bind.
PbsOptions with_classes(int bits, Order order)
{
    PbsOptions options;
    options.order = order;
    if (!(bits & 1)) options.k_stretch = 0.0;
    if (!(bits & 2)) options.k_volume = 0.0;
    if (!(bits & 4)) options.k_bind = 0.0;
    return options;
}

class LeftOut : public testing::TestWithParam<Order> {};

TEST_P(LeftOut, AClassOfStiffnessZeroIsNeverBuilt)
{
    for (int bits = 0; bits < 8; ++bits) {
        SCOPED_TRACE(bits);
        const PbsOptions options = with_classes(bits, GetParam());
        const ConstraintSet<float> set = make_constraint_set<float>(bar, distance, {}, options);
        EXPECT_EQ(set.stretch.empty(), !(bits & 1));
        EXPECT_EQ(set.volume.empty(), !(bits & 2));
        EXPECT_EQ(set.bind.empty(), !(bits & 4));
        if (GetParam() == Order::plain) continue;
        const BatchedConstraints<float> batched = make_batched_constraints(set, bar.tets);
        EXPECT_EQ(batched.stretch.batches() == 0, !(bits & 1));
        EXPECT_EQ(batched.volume.batches() == 0, !(bits & 2));
    }
}

TEST_P(LeftOut, WithoutAnyClassTheStepIsLbs)
{
    PbsSolver solver(bar, distance, {}, with_classes(0, GetParam()));
    const Positions moved = bar.rest.rowwise() + Eigen::RowVector3d(0.25, 0.5, -1.0);  // exact in float
    solver.advance(moved, moved, 0.01);
    // One rounding to float relative to the mean position, 1.5 m away at most, and three in double.
    const double rounding_m =
        test_support::rounding_error_in<float>(1, 1.5) + test_support::rounding_error_in<double>(3, 3.25 + 1.5);
    EXPECT_LT((solver.positions() - moved).cwiseAbs().maxCoeff(), rounding_m);
}

INSTANTIATE_TEST_SUITE_P(Orders, LeftOut, testing::Values(Order::plain, Order::ordered),
                         [](const auto& order) { return order.param == Order::plain ? "plain" : "ordered"; });

class WithoutJiggle : public testing::TestWithParam<bool> {};

TEST_P(WithoutJiggle, NoVelocityExists)
{
    PbsOptions options;
    options.gravity_m_s2 = Vec3(0.0, -9.81, 0.0);
    std::vector<bool> zone;
    if (GetParam()) zone.assign(bar.rest.rows(), true);  // a zone alone does not jiggle
    Particles particles(bar.rest, zone, options);
    for (int step = 0; step < 3; ++step) {
        particles.predict(bar.rest, 0.01);
        particles.update(0.01);
        EXPECT_EQ(particles.velocities().rows(), 0);
        EXPECT_EQ(particles.positions(), bar.rest);  // gravity acts only on vertices that are integrated
    }
}

INSTANTIATE_TEST_SUITE_P(Zones, WithoutJiggle, testing::Bool());

TEST(WithJiggle, OnlyTheZoneHasVelocities)
{
    PbsOptions options;
    options.jiggle = Jiggle{};
    std::vector<bool> zone(bar.rest.rows(), false);
    zone[3] = zone[7] = true;
    Particles particles(bar.rest, zone, options);
    particles.predict(bar.rest, 0.01);
    EXPECT_EQ(particles.velocities().rows(), 2);
}

// Sleep: constraints that LBS satisfies, and whose neighbours it satisfies too, are left out of the frame. Reference:
// the same solver without sleep.

const double bar_edge = 0.1;
const TetMesh long_bar = test_support::structured_bar({0, 0, 0}, {4.0, 0.3, 0.3}, {40, 3, 3});

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
    PbsSolver solver(long_bar, Eigen::VectorXd::Zero(long_bar.rest.rows()), {}, options);
    Step step;
    step.summary = solver.advance(lbs, lbs, 0.01);
    step.positions = solver.positions();
    return step;
}

// The last layer, displaced from the rest.
Positions pulled(double metres)
{
    Positions lbs = long_bar.rest;
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
    const Positions moved = long_bar.rest.rowwise() + Eigen::RowVector3d(1.0, 2.0, 3.0);
    const Step step = step_from(moved, options_of(GetParam(), true));
    EXPECT_EQ(step.summary.sleeping_share, 1.0);
    EXPECT_EQ(step.summary.wakings, 0);
    EXPECT_EQ(step.positions, moved);
}

// Within 24 iterations, the displacement reaches farther than the three rings that are kept awake around the
// disturbance.
TEST_P(Sleep, AFrameIsRedoneWhereASleepingRegionIsDisturbed)
{
    const Positions lbs = pulled(0.1);
    const Step asleep = step_from(lbs, options_of(GetParam(), true)),
               awake = step_from(lbs, options_of(GetParam(), false));
    EXPECT_GE(asleep.summary.wakings, 1);
    EXPECT_GT(asleep.summary.sleeping_share, 0.1);  // and the far end still sleeps
    EXPECT_EQ(awake.summary.wakings, 0);
    EXPECT_EQ(awake.summary.sleeping_share, 0.0);
    // A constraint that was left out would have corrected at most its error, below the tolerance times its edge, in
    // each iteration.
    const double tolerance = PbsOptions{}.sleep_tolerance;
    EXPECT_LT(largest_distance(asleep.positions, awake.positions), 24 * tolerance * bar_edge);
}

TEST_P(Sleep, WithoutToleranceNothingThatIsOffSleeps)
{
    PbsOptions options = options_of(GetParam(), true);
    options.sleep_tolerance = 0.0;
    const Positions lbs = 1.01 * long_bar.rest;
    const Step asleep = step_from(lbs, options), awake = step_from(lbs, options_of(GetParam(), false));
    // only empty batches: pauses at the end of a class, some five of four hundred
    EXPECT_LT(asleep.summary.sleeping_share, 0.02);
    EXPECT_EQ(asleep.positions, awake.positions);
}

INSTANTIATE_TEST_SUITE_P(Orders, Sleep, testing::Values(Order::ordered), [](const auto&) { return "ordered"; });

}  // namespace
}  // namespace left_out_tests
