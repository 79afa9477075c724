// Reference: NIST Statistical Reference Dataset "Norris" (36 points, certified to 15 digits), and power laws. Tolerance for Norris: 1e-10
// relative, the precision of double after sums over 36 points of 15 certified digits.
#include "analysis/line_fit.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::fit_line;
using analysis::observed_order;

const std::vector<double> norris_x = {0.2, 337.4, 118.2, 884.6, 10.1,  226.5, 666.3, 996.3, 448.6, 777.0, 558.2, 0.4,
                                      0.6, 775.5, 666.9, 338.0, 447.5, 11.6,  556.0, 228.1, 995.8, 887.6, 120.2, 0.3,
                                      0.3, 556.8, 339.1, 887.2, 999.0, 779.0, 11.1,  118.3, 229.2, 669.1, 448.9, 0.5};
const std::vector<double> norris_y = {0.1, 338.8, 118.1, 888.0, 9.2,   228.1, 668.5, 998.5, 449.1, 778.9, 559.2, 0.3,
                                      0.1, 778.1, 668.8, 339.3, 448.9, 10.8,  557.7, 228.3, 998.0, 888.8, 119.6, 0.3,
                                      0.6, 557.6, 339.3, 888.0, 998.5, 778.9, 10.2,  117.6, 228.9, 668.4, 449.2, 0.2};

TEST(LineFit, NorrisCertifiedValues)
{
    const auto fit = fit_line(norris_x, norris_y);
    EXPECT_NEAR(fit.slope.estimate, 1.00211681802045, 1e-10);
    EXPECT_NEAR(fit.intercept.estimate, -0.262323073774029, 1e-10);
    EXPECT_NEAR(fit.residual_rms * std::sqrt(36.0 / 34.0), 0.884796396144373, 1e-10);
    const double t = gsl_cdf_tdist_Pinv(0.975, 34);
    EXPECT_NEAR(fit.slope.high - fit.slope.estimate, t * 0.000429796848199937, 1e-12);
    EXPECT_NEAR(fit.intercept.estimate - fit.intercept.low, t * 0.232818234301152, 1e-9);
    EXPECT_EQ(fit.slope.n, 36);
}

TEST(LineFit, ExactLineHasNoWidth)
{
    const auto fit = fit_line({0.0, 1.0, 3.0, 4.0}, {1.0, 3.0, 7.0, 9.0});
    EXPECT_NEAR(fit.slope.estimate, 2.0, 1e-14);
    EXPECT_NEAR(fit.slope.low, 2.0, 1e-12);
    EXPECT_NEAR(fit.intercept.high, 1.0, 1e-12);
}

TEST(LineFit, TwoPointsHaveNoInterval)
{
    const auto fit = fit_line({0.0, 1.0}, {1.0, 3.0});
    EXPECT_NEAR(fit.slope.estimate, 2.0, 1e-15);
    EXPECT_TRUE(std::isnan(fit.slope.low));
}

TEST(ObservedOrder, OfAPowerLawIsItsExponent)
{
    const std::vector<double> h = {0.1, 0.05, 0.025, 0.0125};
    std::vector<double> error;
    for (double size : h) error.push_back(3.0 * std::pow(size, 1.75));
    const auto fit = observed_order(h, error);
    EXPECT_NEAR(fit.slope.estimate, 1.75, 1e-12);
    EXPECT_NEAR(fit.intercept.estimate, std::log(3.0), 1e-12);
}

TEST(LineFit, RefusesWhatHasNoLine)
{
    EXPECT_THROW(fit_line({1.0}, {1.0}), pbs::InputError);
    EXPECT_THROW(fit_line({1.0, 2.0}, {1.0}), pbs::InputError);
    EXPECT_THROW(fit_line({1.0, 1.0}, {1.0, 2.0}), pbs::InputError);
    EXPECT_THROW(observed_order({0.1, 0.05}, {0.0, 1.0}), pbs::InputError);
}

}  // namespace
