// Reference: closed forms, evaluated by hand and independent of GSL.

#include "analysis/statistics/statistics.hpp"
#include "tests/support/rounding_error.hpp"

#include <cmath>

namespace {

using namespace analysis;

TEST(Statistics, OfOneToFive)
{
    const std::vector<double> values = {5, 1, 4, 2, 3};
    EXPECT_EQ(mean(values), 3.0);
    EXPECT_EQ(median(values), 3.0);
    EXPECT_EQ(quantile(values, 0.0), 1.0);
    EXPECT_EQ(quantile(values, 0.25), 2.0);
    // The place 0.9 of 4 goes through two roundings, the value between 4 and 5 through four.
    EXPECT_NEAR(quantile(values, 0.9), 4.6,
                test_support::rounding_error(2, 3.6) + test_support::rounding_error(4, 4.6));
    EXPECT_EQ(quantile(values, 1.0), 5.0);
    // The running mean of squares is rounded three times per value, and its root halves a relative error.
    EXPECT_NEAR(standard_deviation(values), std::sqrt(2.5),
                test_support::rounding_error(3 * 5 / 2.0 + 2, std::sqrt(2.5)));
}

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

struct Known {
    const char* name;
    double value, expected;
};

TEST(Statistics, OfFewValuesAreKnown)
{
    const std::vector<Known> all = {
        {"the median of an even number is the middle", median({1.0, 2.0, 10.0, 4.0}), 3.0},
        {"a quantile is linear between two", quantile({0.0, 1.0}, 0.3), 0.3},
        {"no mean of nothing", mean({}), no_number},
        {"no median of nothing", median({}), no_number},
        {"no deviation of one", standard_deviation({1.0}), no_number},
        {"NaN is not sorted away", quantile({1.0, no_number, 2.0}, 0.5), no_number},
        {"autocorrelation of a constant series", integrated_autocorrelation_time(std::vector<double>(20, 0.5)), 1.0},
        {"an alternating series is not below one", integrated_autocorrelation_time({1, -1, 1, -1, 1, -1, 1, -1}), 1.0},
        {"autocorrelation of no sample", integrated_autocorrelation_time({}), 1.0},
        {"autocorrelation of one sample", integrated_autocorrelation_time({3.0}), 1.0},
        {"the block of uncorrelated samples", static_cast<double>(block_length({1, -1, 1, -1, 1, -1, 1, -1})), 1.0},
        {"no correlation of one", rank_correlation({1}, {1}), no_number},
        {"no rank of NaN", rank_correlation({1, 2}, {1, no_number}), no_number}};
    for (const Known& of : all) {
        const bool none = std::isnan(of.value) && std::isnan(of.expected);
        EXPECT_TRUE(none || of.value == of.expected) << of.name << ": " << of.value;
    }
}

// Spearman 1904: 1 - 6 sum d^2 / (n (n^2 - 1)) without ties; n = 5, d = 0, 0, 1, 1, 0.
TEST(Statistics, RankCorrelationIsOfRanksAlone)
{
    EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4, 5}, {1, 10, 1000, 100, 1e6}), 1.0 - 6.0 * 2.0 / 120.0);
    EXPECT_EQ(rank_correlation({1, 2, 3, 4, 5}, {5, 4, 2, 3, 1}), -0.9);  // exactly, since C09b has its bound there
    EXPECT_EQ(rank_correlation({1, 2, 3}, {5, 7, 90}), 1.0);
    EXPECT_EQ(rank_correlation({1, 2, 3}, {9, 2, 1}), -1.0);
}

// The last pair alone turns the order round. Without it, the correlation is 1.
TEST(Statistics, RankCorrelationWithoutOneHasTheRangeOfAllSuchSamples)
{
    const Interval all = rank_correlation_without_one({1, 2, 3, 4}, {1, 2, 3, 0});
    EXPECT_EQ(all.estimate, rank_correlation({1, 2, 3, 4}, {1, 2, 3, 0}));
    EXPECT_EQ(all.low, rank_correlation({1, 2, 4}, {1, 2, 0}));
    EXPECT_EQ(all.high, 1.0);
    EXPECT_EQ(all.n, 4);
}

// Reference: degenerate cases by definition, and reproducibility by seed. tests/verification/analysis/statistics.cpp
// tests the coverage.

using test_support::mean_error;

const std::vector<double> series = {0.3, 0.4, 0.4, 0.5, 0.6, 0.7, 0.9, 0.8, 1.0, 1.0, 1.1, 1.2, 1.2, 1.4, 1.3, 1.4};

TEST(Bootstrap, EnclosesItsEstimateAndIsWiderAtAHigherLevel)
{
    const Interval interval = bootstrap_mean(series);
    EXPECT_NEAR(interval.estimate, 14.2 / 16.0, mean_error(16, 14.2 / 16.0));
    EXPECT_LT(interval.low, interval.estimate);
    EXPECT_GT(interval.high, interval.estimate);
    EXPECT_EQ(interval.level, 0.95);
    EXPECT_EQ(interval.n, 16);
    EXPECT_GE(interval.block, 2);
    EXPECT_LE(interval.block, 8);
    const Interval narrow = bootstrap_mean(series, {.level = 0.5}), wide = bootstrap_mean(series, {.level = 0.99});
    EXPECT_LT(wide.low, narrow.low);
    EXPECT_GT(wide.high, narrow.high);
}

TEST(Bootstrap, RepeatsToTheBitFollowsItsSeedAndKeepsAGivenBlock)
{
    const Interval a = bootstrap_mean(series), b = bootstrap_mean(series), c = bootstrap_mean(series, {.seed = 2});
    EXPECT_EQ(std::pair(a.low, a.high), std::pair(b.low, b.high));
    EXPECT_NE(std::pair(a.low, a.high), std::pair(c.low, c.high));
    EXPECT_EQ(bootstrap_mean(series, {.block = 3}).block, 3);
    EXPECT_EQ(bootstrap_mean(series, {.block = 99}).block, 16);
    const Interval interval = bootstrap_mean(series, {.block = 16});
    const double of_two_orders = 2.0 * mean_error(16, interval.estimate);
    EXPECT_NEAR(interval.low, interval.estimate, of_two_orders);
    EXPECT_NEAR(interval.high, interval.estimate, of_two_orders);
    const Interval same = bootstrap_mean(std::vector<double>(20, 3.5));
    EXPECT_EQ(std::pair(same.low, same.high), std::pair(3.5, 3.5));
}

// Clopper and Pearson 1934: none of n independent samples holds with probability (1 - p)^n, which is 2.5 % at p = 1 -
// 0.025^(1/n). Tables of the exact bound print 0.16843 for 0 of 20: half of the last digit. 200 samples with an
// autocorrelation time of 10 are equivalent to 20.
TEST(Bootstrap, AShareOfAllOrNoneHasTheExactBinomialBound)
{
    const Interval none = bootstrap_share(std::vector<bool>(20, false)),
                   all = bootstrap_share(std::vector<bool>(20, true));
    EXPECT_EQ(none.low, 0.0);
    EXPECT_NEAR(none.high, 0.16843, 0.5e-5);
    EXPECT_NEAR(all.low, 1.0 - 0.16843, 0.5e-5);
    EXPECT_EQ(all.high, 1.0);
    EXPECT_NEAR(bootstrap_share(std::vector<bool>(200, false), {.autocorrelation_time = 10.0}).high, 0.16843, 0.5e-5);
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
    EXPECT_TRUE(std::isnan(bootstrap_mean({1.0, no_number, 2.0}).high));
    EXPECT_TRUE(std::isnan(bootstrap_mean({1.0, std::numeric_limits<double>::infinity(), 2.0}).low));
}

// Reference: theory where none or all are counted; else the definition, by sums of the binomial distribution.

// The probability of `counted` or fewer out of `all` with probability p each.
double at_most(int counted, int all, double p)
{
    double sum = 0.0;
    for (int k = 0; k <= counted; ++k)
        sum += std::exp(std::lgamma(all + 1.0) - std::lgamma(k + 1.0) - std::lgamma(all - k + 1.0) + k * std::log(p) +
                        (all - k) * std::log1p(-p));
    return sum;
}

// The rounding error of such a probability, here or in the inverse: the logarithm of a term contains three log-gamma
// functions and two products with logarithms of shares, of magnitude 9 at most, each of which goes through ten
// roundings. (GSL's inverse converges cubically and ends after a step below 1e-10: only rounding is left.)
double probability_error(int all)
{
    return test_support::rounding_error(10, 3.0 * std::lgamma(all + 1.0) + 9.0 * all);
}

TEST(ShareInterval, EndsWhereTheTailsAreAFortieth)
{
    for (const int all : {4, 18, 161})
        for (int counted = 1; counted < all; ++counted) {
            const auto share = share_interval(counted, all);
            EXPECT_EQ(share.estimate, double(counted) / all);
            EXPECT_NEAR(at_most(counted, all, share.high), 0.025, 2.0 * probability_error(all));
            EXPECT_NEAR(1.0 - at_most(counted - 1, all, share.low), 0.025, 2.0 * probability_error(all));
        }
}

// An error of the probability (1 - p)^n = 0.025 is one of p over its derivative, n 0.025 / (1 - p) > n 0.025.
TEST(ShareInterval, OfNoneAndOfAllAndWiderOfFewerAndOfAHigherLevel)
{
    for (const int all : {1, 8, 100}) {
        const double end = 1.0 - std::pow(0.025, 1.0 / all);
        const auto none = share_interval(0, all), every = share_interval(all, all);
        EXPECT_EQ(none.low, 0.0);
        const double rounding = probability_error(all) / (0.025 * all) + test_support::rounding_error(4, 1.0);
        EXPECT_NEAR(none.high, end, rounding);
        EXPECT_NEAR(every.low, 1.0 - end, rounding);
        EXPECT_EQ(every.high, 1.0);
    }
    EXPECT_GT(share_interval(2, 8).high - share_interval(2, 8).low,
              share_interval(20, 80).high - share_interval(20, 80).low);
    EXPECT_GT(share_interval(2, 8, 0.99).high, share_interval(2, 8, 0.95).high);
}

// Reference: order statistics of a few frames by hand, linear between them.

CsvTable metrics()
{
    return CsvTable({"scene", "deformer", "variant", "order", "precision", "iterations", "frame", "volume_change_pct",
                     "volume_abs_change_pct", "error_joint_pct"});
}

TEST(FrameStatistics, OfEachSettingByItself)
{
    CsvTable table = metrics();
    for (int frame = 0; frame <= 10; ++frame) {  // 0, -1, ... -10; the order of frames does not matter
        table.add_row(
            {"limb", "pbs", "default", "ordered", "f32", 24, frame, -1.0 * ((7 * frame) % 11), 2.0, std::nullopt});
        table.add_row({"limb", "pbs", "default", "ordered", "f32", 1, frame, 5.0, 3.0, std::nullopt});
    }
    const CsvTable statistics = frame_statistics(table);
    ASSERT_EQ(statistics.rows(), 2);
    EXPECT_EQ(statistics.text_at(0, "iterations"), "24");
    EXPECT_EQ(statistics.integer(0, "frames"), 11);
    for (const auto& [name, value] :
         {std::pair("least", -10.0), {"p10", -9.0}, {"median", -5.0}, {"p90", -1.0}, {"most", 0.0}})
        EXPECT_DOUBLE_EQ(statistics.number(0, std::string("volume_change_") + name + "_pct"), value) << name;
    EXPECT_EQ(statistics.number(0, "volume_abs_change_median_pct"), 2.0);
    EXPECT_EQ(statistics.number(1, "volume_change_median_pct"), 5.0);
}

TEST(FrameStatistics, FramesWithoutAValueAreLeftOut)
{
    CsvTable table = metrics();
    table.add_row({"walk", "lbs", "default", "", "f64", std::nullopt, 0, 1.0, 1.0, std::nullopt});
    table.add_row({"walk", "lbs", "default", "", "f64", std::nullopt, 1, no_number, 1.0, 30.0});
    const CsvTable statistics = frame_statistics(table);
    ASSERT_EQ(statistics.rows(), 1);
    EXPECT_EQ(statistics.number(0, "volume_change_median_pct"), 1.0);
    EXPECT_EQ(statistics.number(0, "error_joint_median_pct"), 30.0);
    // a run without a reference has no such column
    EXPECT_FALSE(statistics.number_or_nothing(0, "error_l2_median_pct"));
}

}  // namespace
