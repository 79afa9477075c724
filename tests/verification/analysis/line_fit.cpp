// Reference: NIST Statistical Reference Dataset "Norris" (36 points, certified to 15 digits), and power laws. Tolerances: half a unit of
// the last certified digit, and the rounding of a fit.
#include "analysis/line_fit.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using analysis::fit_line;
using analysis::observed_order;
using test_support::rounding_error;

// The rounding of a fit to n points: running means in three roundings of each point; slope, the quotient of two sums of products of
// deviations, each in eight roundings with those of the means; intercept, from the means and the slope; a residual, from four terms.
struct FitRounding {
    double slope, intercept, residual;

    FitRounding(const std::vector<double>& x, const std::vector<double>& y, double fitted_slope)
    {
        const auto largest = [](const std::vector<double>& v) {
            return std::max(*std::max_element(v.begin(), v.end()), -*std::min_element(v.begin(), v.end()));
        };
        const double n = static_cast<double>(x.size());
        slope = rounding_error(2.0 * (n + 8), std::abs(fitted_slope));
        intercept = rounding_error(3.0 * n, largest(y) + std::abs(fitted_slope) * largest(x)) + slope * largest(x);
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
    const auto fit = fit_line(norris_x, norris_y);
    const FitRounding rounding(norris_x, norris_y, 1.0);
    EXPECT_NEAR(fit.slope.estimate, 1.00211681802045, 0.5e-14 + rounding.slope);
    EXPECT_NEAR(fit.intercept.estimate, -0.262323073774029, 0.5e-15 + rounding.intercept);
    EXPECT_NEAR(fit.residual_rms * std::sqrt(36.0 / 34.0), 0.884796396144373, 0.5e-15 + rounding.residual);
    // Standard errors are proportional to the residual.
    const double t = gsl_cdf_tdist_Pinv(0.975, 34), relative = (rounding.residual + 0.5e-15) / 0.88;
    EXPECT_NEAR(fit.slope.high - fit.slope.estimate, t * 0.000429796848199937, t * 0.00043 * relative + rounding_error(2, 1.0));
    EXPECT_NEAR(fit.intercept.estimate - fit.intercept.low, t * 0.232818234301152, t * 0.233 * relative);
    EXPECT_EQ(fit.slope.n, 36);
}

TEST(LineFit, ExactLineHasNoWidth)
{
    const std::vector<double> x = {0.0, 1.0, 3.0, 4.0}, y = {1.0, 3.0, 7.0, 9.0};
    const auto fit = fit_line(x, y);
    const FitRounding rounding(x, y, 2.0);
    // Residuals are rounding errors: the standard errors are at most their root mean square over two degrees of freedom, times the root of
    // 1 / Sxx for the slope and of 1 / n + mean^2 / Sxx for the intercept, with Sxx = 10 and a mean of 2.
    const double wide = gsl_cdf_tdist_Pinv(0.975, 2) * std::sqrt(4.0 / 2.0) * rounding.residual;
    EXPECT_NEAR(fit.slope.estimate, 2.0, rounding.slope);
    EXPECT_NEAR(fit.slope.low, 2.0, rounding.slope + wide * std::sqrt(1.0 / 10.0));
    EXPECT_NEAR(fit.intercept.high, 1.0, rounding.intercept + wide * std::sqrt(1.0 / 4.0 + 4.0 / 10.0));
}

TEST(LineFit, TwoPointsHaveNoInterval)
{
    const auto fit = fit_line({0.0, 1.0}, {1.0, 3.0});
    EXPECT_DOUBLE_EQ(fit.slope.estimate, 2.0);
    EXPECT_TRUE(std::isnan(fit.slope.low));
}

TEST(ObservedOrder, OfAPowerLawIsItsExponent)
{
    const std::vector<double> h = {0.1, 0.05, 0.025, 0.0125};
    std::vector<double> error;
    for (double size : h) error.push_back(3.0 * std::pow(size, 1.75));
    const auto fit = observed_order(h, error);
    // Errors go through four roundings and their logarithms through one more; errors of the logarithms turn the line by at most their size
    // over the deviations' mean magnitude, since slope = sum of deviation times y over the sum of squared deviations.
    const std::vector<double> x = {std::log(h[0]), std::log(h[1]), std::log(h[2]), std::log(h[3])};
    const FitRounding rounding(x, {std::log(error[0]), std::log(error[3])}, 1.75);
    const double of_logarithms = rounding_error(4, 1.0) + rounding_error(1, -std::log(error[3])) + 1.75 * rounding_error(1, -x[3]);
    const double of_slope = rounding.slope + of_logarithms / (std::log(2.0) * (1.5 * 1.5 + 0.5 * 0.5) / (1.5 + 0.5));
    EXPECT_NEAR(fit.slope.estimate, 1.75, of_slope);
    EXPECT_NEAR(fit.intercept.estimate, std::log(3.0), rounding.intercept + of_logarithms + of_slope * -x[3]);
}

TEST(LineFit, RefusesWhatHasNoLine)
{
    EXPECT_THROW(fit_line({1.0}, {1.0}), pbs::InputError);
    EXPECT_THROW(fit_line({1.0, 2.0}, {1.0}), pbs::InputError);
    EXPECT_THROW(fit_line({1.0, 1.0}, {1.0, 2.0}), pbs::InputError);
    EXPECT_THROW(observed_order({0.1, 0.05}, {0.0, 1.0}), pbs::InputError);
}

}  // namespace
