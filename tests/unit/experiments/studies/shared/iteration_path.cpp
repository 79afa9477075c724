// Reference: the solver's own step for the end of a path, its own residuals for the measurements on positions, and a uniformly scaled body,
// whose residuals are known.
#include "experiments/studies/shared/iteration_path.hpp"

#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

using experiments::IterationMetrics;
using experiments::IterationPath;
using experiments::Look;
using pbs::Order;
using pbs::Precision;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(limb);

IterationPath path_of(const pbs::PbsOptions& options, const pbs::Positions& start, int most)
{
    const IterationMetrics iteration_metrics(character, limb.bind_points);
    return experiments::iterate(character, options, limb.bind_points, {start}, most, iteration_metrics).front();
}

class IterationPathOf : public testing::TestWithParam<std::pair<Order, Precision>> {};

TEST_P(IterationPathOf, LeadsWhereTheSolverGoesToTheBit)
{
    pbs::PbsOptions options;
    std::tie(options.order, options.precision) = GetParam();
    options.iterations = 24;
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
    solver.advance(limb.lbs, limb.bind_points, 0.01);
    EXPECT_EQ(path_of(options, limb.lbs, 24).last, solver.positions());
}

// Float residuals of the solver are sums of rounded values: some 1e-7 each, over lengths that differ by 1e-2.
TEST_P(IterationPathOf, HasTheResidualsOfTheSolverMeasuredOnItsPositions)
{
    pbs::PbsOptions options;
    std::tie(options.order, options.precision) = GetParam();
    options.iterations = 24;
    options.record_iterations = true;
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
    const auto history = solver.advance(limb.lbs, limb.bind_points, 0.01).history;
    const IterationPath path = path_of(options, limb.lbs, 24);
    ASSERT_EQ(path.looks.size(), 25u);
    const double relative = options.precision == Precision::f32 ? 1e-4 : 1e-9;
    for (int n = 1; n <= 24; ++n) {
        EXPECT_EQ(path.looks[n].iteration, n);
        EXPECT_NEAR(path.looks[n].stretch_rms / history[n - 1].stretch_rms, 1.0, relative);
        EXPECT_NEAR(path.looks[n].volume_rms / history[n - 1].volume_rms, 1.0, relative);
        EXPECT_NEAR(path.looks[n].bind_rms_m / history[n - 1].bind_rms_m, 1.0, relative);
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, IterationPathOf,
                         testing::Values(std::pair(Order::plain, Precision::f64), std::pair(Order::ordered, Precision::f32),
                                         std::pair(Order::grouped, Precision::f64)));

TEST(IterationMetrics, OfAUniformlyScaledBody)
{
    constexpr double scale = 1.1;
    const pbs::Positions rest_points = limb.binding.rest_point;
    const IterationMetrics iteration_metrics(character, scale * rest_points);
    const Look look = iteration_metrics.measure(0, scale * limb.mesh.rest);
    const double stretch = scale - 1.0, volume = std::pow(scale, 3) - 1.0;
    const double bind_m = stretch * std::sqrt(limb.binding.distance.array().square().mean());
    EXPECT_NEAR(look.stretch_rms, stretch, 1e-12);
    EXPECT_NEAR(look.volume_rms, volume, 1e-11);
    EXPECT_NEAR(look.bind_rms_m, bind_m, 1e-12);
    EXPECT_NEAR(look.volume_change_pct, 100.0 * volume, 1e-9);
    const double bind = bind_m / limb.binding.distance.mean();
    EXPECT_NEAR(look.combined, std::sqrt((stretch * stretch + volume * volume + bind * bind) / 3.0), 1e-11);
    EXPECT_TRUE(std::isnan(look.error_joint_pct));
}

TEST(LookedAt, EveryIterationOfThePaperThenTwoPerCent)
{
    const std::vector<int> looks = experiments::looked_at(1000);
    for (int n = 0; n <= 64; ++n) EXPECT_EQ(looks[n], n);
    EXPECT_EQ(looks.back(), 1000);
    for (std::size_t i = 1; i < looks.size(); ++i) {
        EXPECT_GT(looks[i], looks[i - 1]);
        EXPECT_LE(looks[i], std::max(looks[i - 1] + 1.0, std::ceil(1.02 * looks[i - 1])));
    }
    EXPECT_EQ(experiments::looked_at(0), std::vector<int>{0});
}

TEST(Iterate, EndsWherePositionsCeaseToBeFinite)
{
    pbs::Positions broken = limb.lbs;
    broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
    const IterationPath path = path_of({}, broken, 100);
    EXPECT_FALSE(path.finite);
    EXPECT_EQ(path.looks.size(), 1u);
}

TEST(Iterate, OneStartDoesNotRememberAnother)
{
    const IterationMetrics iteration_metrics(character, limb.bind_points);
    const auto both = experiments::iterate(character, {}, limb.bind_points, {limb.mesh.rest, limb.lbs}, 10, iteration_metrics);
    EXPECT_EQ(both[1].last, path_of({}, limb.lbs, 10).last);
}

}  // namespace
