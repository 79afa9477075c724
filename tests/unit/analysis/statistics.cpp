// Reference: closed forms, evaluated by hand and independent of GSL.
#include "analysis/statistics.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

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
    EXPECT_NEAR(quantile(values, 0.9), 4.6, test_support::rounding_error(2, 3.6) + test_support::rounding_error(4, 4.6));
    EXPECT_EQ(quantile(values, 1.0), 5.0);
    // The running mean of squares is rounded three times per value, and its root halves a relative error.
    EXPECT_NEAR(standard_deviation(values), std::sqrt(2.5), test_support::rounding_error(3 * 5 / 2.0 + 2, std::sqrt(2.5)));
    EXPECT_NEAR(standard_error(values), std::sqrt(0.5), test_support::rounding_error(3 * 5 / 2.0 + 4, std::sqrt(0.5)));
}

TEST(Statistics, MedianOfAnEvenNumberIsTheMiddle)
{
    EXPECT_EQ(median({1.0, 2.0, 10.0, 4.0}), 3.0);
}

TEST(Statistics, QuantileIsLinearBetweenTwo)
{
    EXPECT_EQ(quantile({0.0, 1.0}, 0.3), 0.3);
}

TEST(Statistics, TooFewValuesAreNaN)
{
    EXPECT_TRUE(std::isnan(mean({})));
    EXPECT_TRUE(std::isnan(median({})));
    EXPECT_TRUE(std::isnan(standard_deviation({1.0})));
    EXPECT_TRUE(std::isnan(standard_error({})));
}

TEST(Statistics, NaNIsNotSortedAway)
{
    EXPECT_TRUE(std::isnan(quantile({1.0, std::nan(""), 2.0}, 0.5)));
}

TEST(AutocorrelationTime, OfAConstantSeriesIsOne)
{
    EXPECT_EQ(integrated_autocorrelation_time(std::vector<double>(20, 0.5)), 1.0);
}

TEST(AutocorrelationTime, OfAnAlternatingSeriesIsNotBelowOne)
{
    EXPECT_EQ(integrated_autocorrelation_time({1, -1, 1, -1, 1, -1, 1, -1}), 1.0);
}

TEST(AutocorrelationTime, OfTooFewSamplesIsOne)
{
    EXPECT_EQ(integrated_autocorrelation_time({}), 1.0);
    EXPECT_EQ(integrated_autocorrelation_time({3.0}), 1.0);
}

// Spearman 1904: 1 - 6 sum d^2 / (n (n^2 - 1)) without ties; n = 5, d = 0, 0, 1, 1, 0.
TEST(Statistics, RankCorrelationIsOfRanksAlone)
{
    EXPECT_DOUBLE_EQ(analysis::rank_correlation({1, 2, 3, 4, 5}, {1, 10, 1000, 100, 1e6}), 1.0 - 6.0 * 2.0 / 120.0);
    EXPECT_DOUBLE_EQ(analysis::rank_correlation({1, 2, 3}, {5, 7, 90}), 1.0);
    EXPECT_DOUBLE_EQ(analysis::rank_correlation({1, 2, 3}, {9, 2, 1}), -1.0);
    EXPECT_TRUE(std::isnan(analysis::rank_correlation({1}, {1})));
    EXPECT_TRUE(std::isnan(analysis::rank_correlation({1, 2}, {1, std::nan("")})));
}

}  // namespace
