// Reference: degenerate cases by definition, and reproducibility by seed. tests/verification/analysis/bootstrap.cpp tests the coverage.
#include "analysis/bootstrap.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using analysis::bootstrap_mean;
using analysis::bootstrap_share;
using analysis::Interval;
using test_support::mean_error;

const std::vector<double> series = {0.3, 0.4, 0.4, 0.5, 0.6, 0.7, 0.9, 0.8, 1.0, 1.0, 1.1, 1.2, 1.2, 1.4, 1.3, 1.4};

TEST(Bootstrap, EnclosesItsEstimate)
{
    const Interval interval = bootstrap_mean(series);
    EXPECT_NEAR(interval.estimate, 14.2 / 16.0, mean_error(16, 14.2 / 16.0));
    EXPECT_LT(interval.low, interval.estimate);
    EXPECT_GT(interval.high, interval.estimate);
    EXPECT_EQ(interval.level, 0.95);
    EXPECT_EQ(interval.n, 16);
    EXPECT_GE(interval.block, 2);
    EXPECT_LE(interval.block, 8);
}

TEST(Bootstrap, RepeatsToTheBitAndFollowsItsSeed)
{
    const Interval a = bootstrap_mean(series), b = bootstrap_mean(series), c = bootstrap_mean(series, {.seed = 2});
    EXPECT_EQ(a.low, b.low);
    EXPECT_EQ(a.high, b.high);
    EXPECT_TRUE(a.low != c.low || a.high != c.high);
}

TEST(Bootstrap, HigherLevelIsWider)
{
    const Interval narrow = bootstrap_mean(series, {.level = 0.5}), wide = bootstrap_mean(series, {.level = 0.99});
    EXPECT_LT(wide.low, narrow.low);
    EXPECT_GT(wide.high, narrow.high);
}

TEST(Bootstrap, GivenBlockIsKept)
{
    EXPECT_EQ(bootstrap_mean(series, {.block = 3}).block, 3);
    EXPECT_EQ(bootstrap_mean(series, {.block = 99}).block, 16);
}

TEST(Bootstrap, BlockAsLongAsTheSeriesHasNoSpread)
{
    const Interval interval = bootstrap_mean(series, {.block = 16});
    const double of_two_orders = 2.0 * mean_error(16, interval.estimate);
    EXPECT_NEAR(interval.low, interval.estimate, of_two_orders);
    EXPECT_NEAR(interval.high, interval.estimate, of_two_orders);
}

TEST(Bootstrap, SeriesWithoutSpreadHasNoWidth)
{
    const Interval same = bootstrap_mean(std::vector<double>(20, 3.5));
    EXPECT_EQ(same.low, 3.5);
    EXPECT_EQ(same.high, 3.5);
}

// Clopper and Pearson 1934: none of n independent samples holds with probability (1 - p)^n, which is 2.5 % at p = 1 - 0.025^(1/n).
TEST(Bootstrap, AShareOfAllOrNoneHasTheExactBinomialBound)
{
    const Interval none = bootstrap_share(std::vector<bool>(20, false));
    EXPECT_EQ(none.low, 0.0);
    EXPECT_NEAR(none.high, 0.16843, 0.5e-5);  // tables of the exact bound, 0 of 20: half of the last digit
    const Interval all = bootstrap_share(std::vector<bool>(20, true));
    EXPECT_NEAR(all.low, 1.0 - 0.16843, 0.5e-5);
    EXPECT_EQ(all.high, 1.0);
}

TEST(Bootstrap, CorrelatedSamplesSayLessAboutNone)
{
    const Interval correlated = bootstrap_share(std::vector<bool>(200, false), {.autocorrelation_time = 10.0});
    EXPECT_NEAR(correlated.high, 0.16843, 0.5e-5);  // equivalent to 20 independent samples
}

TEST(Bootstrap, ShareStaysBetweenNoneAndAll)
{
    std::vector<bool> holds(40, true);
    holds[11] = holds[12] = false;
    const Interval share = bootstrap_share(holds);
    EXPECT_NEAR(share.estimate, 0.95, mean_error(40, 0.95));
    EXPECT_LT(share.low, 0.95);
    EXPECT_LE(share.high, 1.0);
}

TEST(Bootstrap, TooFewOrBrokenSamplesHaveNoInterval)
{
    EXPECT_TRUE(std::isnan(bootstrap_mean({}).estimate));
    EXPECT_EQ(bootstrap_mean({2.0}).estimate, 2.0);
    EXPECT_TRUE(std::isnan(bootstrap_mean({2.0}).low));
    EXPECT_TRUE(std::isnan(bootstrap_mean({1.0, std::numeric_limits<double>::quiet_NaN(), 2.0}).high));
    EXPECT_TRUE(std::isnan(bootstrap_mean({1.0, std::numeric_limits<double>::infinity(), 2.0}).low));
}

TEST(BlockLength, OfUncorrelatedSamplesIsOne)
{
    EXPECT_EQ(analysis::block_length({1, -1, 1, -1, 1, -1, 1, -1}), 1);
}

}  // namespace
