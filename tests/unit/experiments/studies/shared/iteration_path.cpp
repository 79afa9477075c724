// Reference: the solver's own step for the end of a path, its own residuals for the measurements on positions, and a uniformly scaled body,
// whose residuals are known.
#include "experiments/studies/shared/iteration_path.hpp"

#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/limb_character.hpp"
#include "tests/support/rounding_error.hpp"

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

// The root mean square of residuals differs by no more than the residuals: by eight roundings of a length and of a distance in the solver's
// scalar, over their lengths at rest, and of sixteen of a volume, of products of at most five times its size; no length and no volume
// doubles. The solver's positions are relative to an origin, to which a coordinate of a metre is added in double: over a cell's width of
// 0.075 m these are 2 sqrt 3 / 0.075 roundings of a length and three times as many of a volume. A sum goes through as many roundings as
// there are terms.
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
    using test_support::rounding_error;
    const double of_scalar = options.precision == Precision::f32 ? 0x1p29 : 1.0;  // unit roundoff over that of double
    const double of_coordinate = 2.0 * std::sqrt(3.0) / 0.075, sums = 2.0 * static_cast<double>(limb.mesh.tets.rows());
    const double of_stretch = rounding_error(of_scalar * 8 + of_coordinate + sums, 2.0),
                 of_volume = rounding_error(of_scalar * 16 * 5 + 3 * of_coordinate + sums, 2.0),
                 of_bind_m = rounding_error(of_scalar * 8 + 2 + sums, 1.0);
    for (int n = 1; n <= 24; ++n) {
        EXPECT_EQ(path.looks[n].iteration, n);
        EXPECT_NEAR(path.looks[n].stretch_rms, history[n - 1].stretch_rms, of_stretch);
        EXPECT_NEAR(path.looks[n].volume_rms, history[n - 1].volume_rms, of_volume);
        EXPECT_NEAR(path.looks[n].bind_rms_m, history[n - 1].bind_rms_m, of_bind_m);
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, IterationPathOf,
                         testing::Values(std::pair(Order::plain, Precision::f64), std::pair(Order::ordered, Precision::f32),
                                         std::pair(Order::grouped, Precision::f64)));

// A coordinate of at most 1.1 is rounded once by the scale, over a cell of at least 0.075: 2 / 0.075 = 27 roundings of an edge and 80 of a
// volume, which goes through ten of products of at most five times its size. A ratio contains two volumes or lengths, and one is subtracted
// from it.
TEST(IterationMetrics, OfAUniformlyScaledBody)
{
    constexpr double scale = 1.1;
    const pbs::Positions rest_points = limb.binding.rest_point;
    const IterationMetrics iteration_metrics(character, scale * rest_points);
    const Look look = iteration_metrics.measure(0, scale * limb.mesh.rest);
    const double stretch = scale - 1.0, volume = std::pow(scale, 3) - 1.0;
    const double bind_m = stretch * std::sqrt(limb.binding.distance.array().square().mean());
    using test_support::rounding_error;
    const double of_stretch = rounding_error(27 + 2 * 5, scale) + rounding_error(4, 1.0 + scale),
                 of_volume = rounding_error(80 + 2 * 5 * 10, 1.0 + volume) + rounding_error(4, 2.0 + volume),
                 of_bind_m = rounding_error(2 * std::sqrt(3.0) + 2 * 5, scale);
    EXPECT_NEAR(look.stretch_rms, stretch, of_stretch);
    EXPECT_NEAR(look.volume_rms, volume, of_volume);
    EXPECT_NEAR(look.bind_rms_m, bind_m, of_bind_m);
    EXPECT_NEAR(look.volume_change_pct, 100.0 * volume, 100.0 * of_volume);
    const double bind = bind_m / limb.binding.distance.mean();
    EXPECT_NEAR(look.combined, std::sqrt((stretch * stretch + volume * volume + bind * bind) / 3.0),
                of_stretch + of_volume + of_bind_m / limb.binding.distance.mean());
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
