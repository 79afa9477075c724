// Reference: theory of the first-order autoregressive series x_t = phi x_{t-1} + e_t.
//   variance of the mean of m samples: s^2/m (1 + 2 sum_{k<m} (1 - k/m) phi^k);   tau = (1 + phi) / (1 - phi).
// The moving-block bootstrap with blocks of length b reports on average the variance (b/n) (var_b - var_n), estimated
// with about 3/2 n/b degrees of freedom (overlapping blocks: Kunsch 1989). So its 95 % interval contains the true mean
// with probability P(|t_nu| < 1.96 r), r^2 = reported over true variance, nu = 3/2 n/b. Tolerance: four binomial
// standard errors of the trials.

#include "analysis/statistics/fits.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gsl/gsl_cdf.h>

#include <cmath>
#include <numbers>
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
    double inside = 0.0, too_high = 0.0,
           too_low = 0.0;  // shares of the trials; too_high: the whole interval lies above the true mean
};

Coverage observed_coverage(int block)
{
    std::mt19937_64 random(42);
    Coverage coverage;
    for (int trial = 0; trial < trials; ++trial) {
        const auto interval =
            analysis::bootstrap_mean(autoregressive_series(samples, random),
                                     {.resamples = 400, .seed = static_cast<unsigned long>(trial + 1), .block = block});
        (interval.low > 0.0    ? coverage.too_high
         : interval.high < 0.0 ? coverage.too_low
                               : coverage.inside) += 1.0 / trials;
    }
    return coverage;
}

double four_standard_errors(double coverage)
{
    return 4.0 * std::sqrt(coverage * (1.0 - coverage) / trials);
}

TEST(BlockBootstrap, CoversTheMeanOfAnAutoregressiveSeriesAsTheorySays)
{
    for (const int block : {1, 4, 16}) {
        // the noise is symmetric
        const double expected = expected_coverage(block), either_side = 0.5 * (1.0 - expected);
        const Coverage observed = observed_coverage(block);
        EXPECT_NEAR(observed.inside, expected, four_standard_errors(expected));
        EXPECT_NEAR(observed.too_high, either_side, four_standard_errors(either_side));
        EXPECT_NEAR(observed.too_low, either_side, four_standard_errors(either_side));
    }
}

// With the block length chosen from the series itself, at least the coverage of half the best length for this phi.
TEST(BlockBootstrap, ChoosesABlockThatCovers)
{
    const double tau = (1.0 + phi) / (1.0 - phi);
    const int best = static_cast<int>(std::cbrt(1.5 * samples) * std::pow((tau * tau - 1.0) / (2.0 * tau), 2.0 / 3.0));
    const double least = expected_coverage(best / 2);
    EXPECT_GT(observed_coverage(0).inside, least - four_standard_errors(least));
    EXPECT_GT(least, expected_coverage(1) + four_standard_errors(least));
}

// Relative standard error of the estimate: sqrt(2 (2 W + 1) / n) with the window W = 5 tau (Madras and Sokal 1988), 2 %
// here.
TEST(AutocorrelationTime, OfAnAutoregressiveSeriesIsKnown)
{
    const int n = 200000;
    std::mt19937_64 random(5);
    const double tau = (1.0 + phi) / (1.0 - phi), relative_error = std::sqrt(2.0 * (10.0 * tau + 1.0) / n);
    EXPECT_NEAR(analysis::integrated_autocorrelation_time(autoregressive_series(n, random)), tau,
                4.0 * relative_error * tau);
}

// Reference: NIST Statistical Reference Dataset "Norris" (36 points, certified to 15 digits), and power laws.
// Tolerances: half a unit of the last certified digit, and the rounding of a fit.

using analysis::fit_line;
using analysis::observed_order;
using test_support::rounding_error;

// The rounding of a fit to n points: running means in three roundings of each point; slope, the quotient of two sums of
// products of deviations, each in eight roundings with those of the means; intercept, from the means and the slope; a
// residual, from four terms.
struct FitRounding {
    double slope, residual;

    FitRounding(const std::vector<double>& x, const std::vector<double>& y, double fitted_slope)
    {
        const auto largest = [](const std::vector<double>& v) {
            return std::max(*std::max_element(v.begin(), v.end()), -*std::min_element(v.begin(), v.end()));
        };
        const double n = static_cast<double>(x.size());
        slope = rounding_error(2.0 * (n + 8), std::abs(fitted_slope));
        const double intercept =
            rounding_error(3.0 * n, largest(y) + std::abs(fitted_slope) * largest(x)) + slope * largest(x);
        residual = rounding_error(4, largest(y) + std::abs(fitted_slope) * largest(x)) + intercept + slope * largest(x);
    }
};

const std::vector<double> norris_x = {0.2, 337.4, 118.2, 884.6, 10.1,  226.5, 666.3, 996.3, 448.6, 777.0, 558.2, 0.4,
                                      0.6, 775.5, 666.9, 338.0, 447.5, 11.6,  556.0, 228.1, 995.8, 887.6, 120.2, 0.3,
                                      0.3, 556.8, 339.1, 887.2, 999.0, 779.0, 11.1,  118.3, 229.2, 669.1, 448.9, 0.5};
const std::vector<double> norris_y = {0.1, 338.8, 118.1, 888.0, 9.2,   228.1, 668.5, 998.5, 449.1, 778.9, 559.2, 0.3,
                                      0.1, 778.1, 668.8, 339.3, 448.9, 10.8,  557.7, 228.3, 998.0, 888.8, 119.6, 0.3,
                                      0.6, 557.6, 339.3, 888.0, 998.5, 778.9, 10.2,  117.6, 228.9, 668.4, 449.2, 0.2};

TEST(LineFit, NorrisCertifiedValues)
{
    const auto slope = fit_line(norris_x, norris_y);
    const FitRounding rounding(norris_x, norris_y, 1.0);
    EXPECT_NEAR(slope.estimate, 1.00211681802045, 0.5e-14 + rounding.slope);
    // Standard errors are proportional to the residual.
    const double t = gsl_cdf_tdist_Pinv(0.975, 34), relative = (rounding.residual + 0.5e-15) / 0.88;
    EXPECT_NEAR(slope.high - slope.estimate, t * 0.000429796848199937, t * 0.00043 * relative + rounding_error(2, 1.0));
    EXPECT_EQ(slope.n, 36);
}

TEST(ObservedOrder, OfAPowerLawIsItsExponent)
{
    const std::vector<double> h = {0.1, 0.05, 0.025, 0.0125};
    std::vector<double> error;
    for (double size : h) error.push_back(3.0 * std::pow(size, 1.75));
    const auto slope = observed_order(h, error);
    // Errors go through four roundings and their logarithms through one more; errors of the logarithms turn the line by
    // at most their size over the deviations' mean magnitude, since slope = sum of deviation times y over the sum of
    // squared deviations.
    const std::vector<double> x = {std::log(h[0]), std::log(h[1]), std::log(h[2]), std::log(h[3])};
    const FitRounding rounding(x, {std::log(error[0]), std::log(error[3])}, 1.75);
    const double of_logarithms =
        rounding_error(4, 1.0) + rounding_error(1, -std::log(error[3])) + 1.75 * rounding_error(1, -x[3]);
    const double of_slope = rounding.slope + of_logarithms / (std::log(2.0) * (1.5 * 1.5 + 0.5 * 0.5) / (1.5 + 0.5));
    EXPECT_NEAR(slope.estimate, 1.75, of_slope);
}

TEST(LineFit, AnExactLineHasNoWidthTwoPointsHaveNoIntervalAndOneHasNoLine)
{
    const auto two = fit_line({0.0, 1.0}, {1.0, 3.0});
    EXPECT_DOUBLE_EQ(two.estimate, 2.0);
    EXPECT_TRUE(std::isnan(two.low));
    using Points = std::vector<double>;
    for (const auto& [x, y] : {std::pair(Points{1.0}, Points{1.0}), {{1.0, 2.0}, {1.0}}, {{1.0, 1.0}, {1.0, 2.0}}})
        EXPECT_THROW(fit_line(x, y), pbs::InputError);
    EXPECT_THROW(observed_order({0.1, 0.05}, {0.0, 1.0}), pbs::InputError);
    const std::vector<double> x = {0.0, 1.0, 3.0, 4.0}, y = {1.0, 3.0, 7.0, 9.0};
    const auto slope = fit_line(x, y);
    const FitRounding rounding(x, y, 2.0);
    // Residuals are rounding errors: the standard error is at most their root mean square over two degrees of freedom,
    // times the root of 1 / Sxx = 1 / 10.
    const double wide = gsl_cdf_tdist_Pinv(0.975, 2) * std::sqrt(4.0 / 2.0) * rounding.residual;
    EXPECT_NEAR(slope.estimate, 2.0, rounding.slope);
    EXPECT_NEAR(slope.low, 2.0, rounding.slope + wide * std::sqrt(1.0 / 10.0));
}

// Reference: series made from the formula, with and without noise of a known size.

using analysis::fit_damped_oscillation;
using analysis::OscillationOutcome;

std::vector<double> oscillation(double frequency_hz, double damping_ratio, double noise = 0.0, unsigned seed = 1)
{
    const double omega = 2.0 * std::numbers::pi * frequency_hz;
    const double decay = omega * damping_ratio / std::sqrt(1.0 - damping_ratio * damping_ratio);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<double> series;
    for (int i = 0; i < 300; ++i) {
        const double t = 0.01 * i;
        series.push_back(0.02 + std::exp(-decay * t) * std::cos(omega * t + 0.4) + noise * normal(random));
    }
    return series;
}

// Three seconds at 100 Hz. The fit ends at a step of 1e-10 of each parameter, and without noise the error that remains
// is far smaller than the last step. The damping ratio is a quotient of two parameters.
TEST(DampedOscillation, FrequencyAndDampingComeBack)
{
    for (const double frequency_hz : {1.0, 4.0, 11.0})
        for (const double damping_ratio : {0.005, 0.05, 0.3}) {
            const auto swing = fit_damped_oscillation(oscillation(frequency_hz, damping_ratio), 0.01);
            ASSERT_EQ(swing.outcome, OscillationOutcome::found) << frequency_hz << " " << damping_ratio;
            EXPECT_NEAR(swing.frequency_hz.estimate, frequency_hz, 1e-10 * frequency_hz);
            EXPECT_NEAR(swing.damping_ratio.estimate, damping_ratio, 2.0 * 1e-10 * damping_ratio);
        }
}

// With white noise the 95 % interval contains the true value in 95 of 100 series; fewer than 85 would occur once in
// 30,000 times (binomial).
TEST(DampedOscillation, IntervalHoldsTheTruthAsOftenAsItSays)
{
    int frequency_held = 0, damping_held = 0;
    for (unsigned seed = 0; seed < 100; ++seed) {
        const auto swing = fit_damped_oscillation(oscillation(4.0, 0.03, 0.05, seed), 0.01);
        frequency_held += swing.frequency_hz.low <= 4.0 && 4.0 <= swing.frequency_hz.high;
        damping_held += swing.damping_ratio.low <= 0.03 && 0.03 <= swing.damping_ratio.high;
    }
    EXPECT_GE(frequency_held, 85);
    EXPECT_GE(damping_held, 85);
    EXPECT_LE(frequency_held + damping_held, 199);
}

// A swing of 25 Hz with a damping ratio of 0.3 has decayed after 8 samples.
TEST(DampedOscillation, WhatHasNoPeriodIsNamed)
{
    std::vector<double> creep, one_kick(100, 0.0), noise(300);
    for (int i = 0; i < 300; ++i) creep.push_back(std::exp(-0.03 * i));
    one_kick[0] = 1.0;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (double& y : noise) y = normal(random);
    const std::vector<std::tuple<const char*, std::vector<double>, OscillationOutcome>> all = {
        {"dies at once", oscillation(25.0, 0.3), OscillationOutcome::too_short},
        {"one kick", one_kick, OscillationOutcome::too_short},
        {"a creep", creep, OscillationOutcome::overdamped},
        {"nothing", {}, OscillationOutcome::none},
        {"still", std::vector<double>(50, 3.0), OscillationOutcome::none},
        {"not a number", {1.0, std::nan(""), 2.0}, OscillationOutcome::none},
        {"noise", noise, OscillationOutcome::unclear}};
    for (const auto& [name, series, outcome] : all)
        EXPECT_EQ(fit_damped_oscillation(series, 0.01).outcome, outcome) << name;
}

}  // namespace
