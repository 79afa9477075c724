// Reference: the scheme's own three equations, which the accepted step must satisfy, and the conditions of Chung and Hulbert.
#include "reference_fem/dynamics/time_scheme.hpp"

#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;

class Scheme : public testing::TestWithParam<TimeScheme> {
protected:
    const double h = 0.3;
    const Motion before{Eigen::Vector2d(0.4, -1.0), Eigen::Vector2d(2.0, 0.7), Eigen::Vector2d(-3.0, 0.2)};
    const Eigen::Vector2d w{0.9, -0.5};
};

TEST_P(Scheme, AnAcceptedStepSatisfiesTheEquationsOfTheScheme)
{
    const TimeScheme& s = GetParam();
    const Motion after = accept(s, before, w, h);
    const auto mean = [](double alpha, const Eigen::VectorXd& now, const Eigen::VectorXd& next) -> Eigen::VectorXd {
        return (1.0 - alpha) * next + alpha * now;
    };
    const Eigen::VectorXd u =
        before.displacement + h * before.velocity + h * h * ((0.5 - s.beta) * before.acceleration + s.beta * after.acceleration);
    const Eigen::VectorXd v = before.velocity + h * ((1.0 - s.gamma) * before.acceleration + s.gamma * after.acceleration);
    EXPECT_LT((after.displacement - u).norm(), 1e-14);
    EXPECT_LT((after.velocity - v).norm(), 1e-14);
    EXPECT_LT((mean(s.alpha_f, before.displacement, after.displacement) - w).norm(), 1e-15);
    // Eqs. (d) to (g): the rates in the balance are affine in w. Rounding: eps times c_m of some 1e2.
    EXPECT_LT(
        (mean(s.alpha_m, before.acceleration, after.acceleration) - inertia_coefficient(s, h) * (w - inertia_centre(s, before, h))).norm(),
        1e-12);
    EXPECT_LT((mean(s.alpha_f, before.velocity, after.velocity) - damping_coefficient(s, h) * (w - damping_centre(s, before, h))).norm(),
              1e-13);
}

TEST_P(Scheme, IsOfSecondOrderAndUnconditionallyStable)
{
    const TimeScheme& s = GetParam();
    EXPECT_NEAR(s.gamma, 0.5 - s.alpha_m + s.alpha_f, 1e-15);
    EXPECT_LE(s.alpha_m, s.alpha_f);
    EXPECT_LE(s.alpha_f, 0.5);
    EXPECT_GE(s.beta, 0.25 + (s.alpha_f - s.alpha_m) / 2.0 - 1e-15);
}

INSTANTIATE_TEST_SUITE_P(All, Scheme,
                         testing::Values(newmark(), generalized_alpha(0.0), generalized_alpha(0.5), generalized_alpha(0.8),
                                         generalized_alpha(1.0)));

TEST(GeneralizedAlpha, RefusesASpectralRadiusOutsideZeroToOne)
{
    for (const double radius : {-0.1, 1.1, std::nan("")}) EXPECT_THROW(generalized_alpha(radius), pbs::InputError);
}

TEST(GeneralizedAlpha, OfSpectralRadiusOneHalfIsAsPrinted)
{
    const TimeScheme scheme = generalized_alpha(0.5);
    EXPECT_DOUBLE_EQ(scheme.alpha_m, 0.0);
    EXPECT_DOUBLE_EQ(scheme.alpha_f, 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(scheme.beta, 4.0 / 9.0);
    EXPECT_DOUBLE_EQ(scheme.gamma, 5.0 / 6.0);
}

}  // namespace
