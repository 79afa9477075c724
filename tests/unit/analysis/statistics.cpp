// Reference: closed forms, evaluated by hand and independent of GSL.
#include "analysis/statistics.hpp"

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
    EXPECT_NEAR(quantile(values, 0.9), 4.6, 1e-15);
    EXPECT_EQ(quantile(values, 1.0), 5.0);
    EXPECT_NEAR(standard_deviation(values), std::sqrt(2.5), 1e-15);
    EXPECT_NEAR(standard_error(values), std::sqrt(0.5), 1e-15);
}

TEST(Statistics, MedianOfAnEvenNumberIsTheMiddle)
{
    EXPECT_EQ(median({1.0, 2.0, 10.0, 4.0}), 3.0);
}

TEST(Statistics, QuantileIsLinearBetweenTwo)
{
    EXPECT_NEAR(quantile({0.0, 1.0}, 0.3), 0.3, 1e-15);
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
