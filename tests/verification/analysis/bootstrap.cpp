// Reference: theory of the first-order autoregressive series x_t = phi x_{t-1} + e_t.
//   variance of the mean of m samples: s^2/m (1 + 2 sum_{k<m} (1 - k/m) phi^k);   tau = (1 + phi) / (1 - phi).
// The moving-block bootstrap with blocks of length b reports on average the variance (b/n) (var_b - var_n), estimated with about 3/2 n/b
// degrees of freedom (overlapping blocks: Kunsch 1989). So its 95 % interval contains the true mean with probability P(|t_nu| < 1.96 r),
// r^2 = reported over true variance, nu = 3/2 n/b. Tolerance: four binomial standard errors of the trials.
#include "analysis/bootstrap.hpp"
#include "analysis/statistics.hpp"

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

constexpr double phi = 0.6;
constexpr int samples = 512, trials = 1000;

std::vector<double> autoregressive_series(int n, std::mt19937_64& random)
{
    std::normal_distribution<double> noise;
    std::vector<double> series;
    double value = noise(random) / std::sqrt(1.0 - phi * phi);  // stationary from the first sample
    for (int i = 0; i < n; ++i) {
        series.push_back(value);
        value = phi * value + noise(random);
    }
    return series;
}

double variance_of_mean(int m)
{
    double sum = 1.0;
    for (int k = 1; k < m; ++k) sum += 2.0 * (1.0 - double(k) / m) * std::pow(phi, k);
    return sum / m / (1.0 - phi * phi);
}

double expected_coverage(int block)
{
    const double reported = double(block) / samples * (variance_of_mean(block) - variance_of_mean(samples));
    const double r = std::sqrt(reported / variance_of_mean(samples)), freedom = 1.5 * samples / block;
    return 1.0 - 2.0 * gsl_cdf_tdist_Q(1.96 * r, freedom);
}

struct Coverage {
    double inside = 0.0, too_high = 0.0, too_low = 0.0;  // shares of the trials; too_high: the whole interval lies above the true mean
};

Coverage observed_coverage(int block)
{
    std::mt19937_64 random(42);
    Coverage coverage;
    for (int trial = 0; trial < trials; ++trial) {
        const auto interval = analysis::bootstrap_mean(autoregressive_series(samples, random),
                                                       {.resamples = 400, .seed = static_cast<unsigned long>(trial + 1), .block = block});
        (interval.low > 0.0 ? coverage.too_high : interval.high < 0.0 ? coverage.too_low : coverage.inside) += 1.0 / trials;
    }
    return coverage;
}

double four_standard_errors(double coverage)
{
    return 4.0 * std::sqrt(coverage * (1.0 - coverage) / trials);
}

class BlockBootstrap : public testing::TestWithParam<int> {};

TEST_P(BlockBootstrap, CoversTheMeanAsTheorySays)
{
    const double expected = expected_coverage(GetParam());
    const Coverage observed = observed_coverage(GetParam());
    EXPECT_NEAR(observed.inside, expected, four_standard_errors(expected));
    const double either_side = 0.5 * (1.0 - expected);  // the noise is symmetric
    EXPECT_NEAR(observed.too_high, either_side, four_standard_errors(either_side));
    EXPECT_NEAR(observed.too_low, either_side, four_standard_errors(either_side));
}

INSTANTIATE_TEST_SUITE_P(OfAnAutoregressiveSeries, BlockBootstrap, testing::Values(1, 4, 16));

// With the block length chosen from the series itself, at least the coverage of half the best length for this phi.
TEST(BlockBootstrap, ChoosesABlockThatCovers)
{
    const double tau = (1.0 + phi) / (1.0 - phi);
    const int best = static_cast<int>(std::cbrt(1.5 * samples) * std::pow((tau * tau - 1.0) / (2.0 * tau), 2.0 / 3.0));
    const double least = expected_coverage(best / 2);
    EXPECT_GT(observed_coverage(0).inside, least - four_standard_errors(least));
    EXPECT_GT(least, expected_coverage(1) + four_standard_errors(least));
}

// Relative standard error of the estimate: sqrt(2 (2 W + 1) / n) with the window W = 5 tau (Madras and Sokal 1988), 2 % here.
TEST(AutocorrelationTime, OfAnAutoregressiveSeriesIsKnown)
{
    const int n = 200000;
    std::mt19937_64 random(5);
    const double tau = (1.0 + phi) / (1.0 - phi), relative_error = std::sqrt(2.0 * (10.0 * tau + 1.0) / n);
    EXPECT_NEAR(analysis::integrated_autocorrelation_time(autoregressive_series(n, random)), tau, 4.0 * relative_error * tau);
}

}  // namespace
