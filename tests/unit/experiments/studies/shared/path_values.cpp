// Reference: paths defined by formulas, whose rates and floors are known.
#include "experiments/studies/shared/iteration_path.hpp"

#include "tests/support/fit_rounding.hpp"
#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace experiments;
using test_support::path_by;
using test_support::path_to_floor;

// 1 + 0.9^n <= 1.05 from n = ceil(log 0.05 / log 0.9) = 29 on.
TEST(ReachedResidual, IsTheFirstIterationWithinFivePerCentOfTheFloor)
{
    const IterationPath path = path_to_floor(1000, 1.0, 1.0, 0.9);
    const Reached reached = reached_residual(path, floor_of({path}));
    EXPECT_TRUE(reached.within);
    EXPECT_EQ(reached.iterations, 29);
}

TEST(ReachedResidual, CountsFromWhereItNeverLeavesAgain)
{
    const IterationPath path = path_by(100, [](int n) { return n == 40 ? 1.2 : n < 10 ? 2.0 : 1.0; });
    EXPECT_EQ(reached_residual(path, 1.0).iterations, 41);
}

TEST(ReachedResidual, IsNotReachedByAPathThatStallsAboveTheLowestFloor)
{
    const std::vector<IterationPath> paths = {path_to_floor(100, 1.0, 1.0, 0.5), path_to_floor(100, 1.06, 1.0, 0.5)};
    EXPECT_EQ(floor_of(paths), paths[0].looks.back().combined);
    const Reached reached = reached_residual(paths[1], floor_of(paths));
    EXPECT_FALSE(reached.within);
    EXPECT_EQ(reached.iterations, 100);
}

TEST(ReachedResidual, OfRoundingIsReached)
{
    const IterationPath noise = path_by(100, [](int n) { return n % 2 == 0 ? 3e-7 : 6e-7; });
    EXPECT_EQ(reached_residual(noise, 3e-7).iterations, 0);
    EXPECT_TRUE(reached_residual(noise, 3e-7).within);
}

TEST(FloorOf, LeavesOutWhatBrokeDown)
{
    IterationPath broken = path_by(3, [](int) { return 0.1; });
    broken.finite = false;
    EXPECT_EQ(floor_of({broken, path_by(3, [](int) { return 0.4; })}), 0.4);
    EXPECT_TRUE(std::isnan(floor_of({broken})));
}

TEST(ReachedVolume, IsThePapersHalfPerCent)
{
    EXPECT_EQ(reached_volume(path_by(50, [](int n) { return n < 7 ? 0.51 : 0.5; })).iterations, 7);
    EXPECT_FALSE(reached_volume(path_by(50, [](int) { return 0.51; })).within);
}

// The rounding error of the slope of log(above rate^n) against n = 1, 2, ..., iterations. The numbers 1 + above rate^n are rounded once,
// which the difference from 1 magnifies most at the end; a power, a product and a logarithm of at most `steepest` go through two more,
// each.
double log_rate_error(int iterations, double above, double rate)
{
    std::vector<double> n, logs;
    for (int i = 1; i <= iterations; ++i) n.push_back(i), logs.push_back(std::log(above) + i * std::log(rate));
    const double least = above * std::pow(rate, iterations), steepest = std::max(std::abs(logs.front()), std::abs(logs.back()));
    const double of_logs = test_support::rounding_error(1, (1.0 + least) / least) + test_support::rounding_error(2 + 1 + 2 * steepest, 1.0);
    return test_support::slope_error(n, logs, std::log(rate), 0.0, of_logs);
}

// The end of the path replaces the limit: 0.9^400 is below the spacing of numbers at 1. The residuals of n equidistant points are at most
// the error of a point, which is below that of the slope times n / 3, and that of the slope times n / 2.
TEST(RateOf, IsThatOfTheFormula)
{
    const Rate rate = rate_of(path_to_floor(400, 1.0, 1.0, 0.9), 0.3);
    const double rounding = log_rate_error(29, 1.0, 0.9);
    EXPECT_NEAR(rate.rate.estimate, 0.9, 0.9 * rounding + test_support::rounding_error(2, 0.9));
    EXPECT_LT(rate.log_rms_off, 29.0 * rounding);
    ASSERT_TRUE(rate.stalls_at.has_value());
    EXPECT_EQ(*rate.stalls_at, 29);
}

TEST(RateOf, OfAResidualThatStillFallsIsTakenFromTheFloorOfOthers)
{
    const Rate rate = rate_of(path_to_floor(400, 1.0, 10.0, 0.995), 1.0);
    EXPECT_FALSE(rate.stalls_at.has_value());
    EXPECT_NEAR(rate.rate.estimate, 0.995, 0.995 * log_rate_error(400, 10.0, 0.995) + test_support::rounding_error(2, 0.995));
}

TEST(RateOf, RoundingHasNone)
{
    EXPECT_TRUE(std::isnan(rate_of(path_by(100, [](int n) { return n % 2 == 0 ? 3e-7 : 6e-7; }), 3e-7).rate.estimate));
}

TEST(LookAt, IsTheLastOneNotAfterIt)
{
    IterationPath path = path_by(10, [](int n) { return 1.0 + n; });
    path.looks.erase(path.looks.begin() + 5);
    EXPECT_EQ(look_at(path, 5).iteration, 4);
    EXPECT_EQ(look_at(path, 100).iteration, 10);
}

TEST(NearestToReference, NeedNotBeTheLast)
{
    EXPECT_EQ(nearest_to_reference(path_by(100, [](int n) { return 1.0 + std::abs(n - 13); })).iteration, 13);
}

}  // namespace
