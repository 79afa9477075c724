// Reference: the scheme's own three equations, which the accepted step must satisfy, and the conditions of Chung and Hulbert. Tolerances:
// roundings of the equations' terms, whose magnitudes add up in displacements to `size`; the rates divide them by powers of the step.
#include "reference_fem/dynamics/time_scheme.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;
using test_support::rounding_error;

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
    const double size = before.displacement.norm() + w.norm() + h * before.velocity.norm() + h * h * before.acceleration.norm();
    const double c_m = inertia_coefficient(s, h), c_c = damping_coefficient(s, h);
    // The increment is (w - u) / (1 - alpha_f), twice the size at most. The new acceleration takes it in eight roundings, and the test's
    // own equation in eight.
    EXPECT_LT((after.displacement - u).norm(), rounding_error(8 + 8, 2.0 * size));
    EXPECT_LT((after.velocity - v).norm(),  // six roundings on each side, of the same accelerations
              rounding_error(6 + 6, before.velocity.norm() + h * (before.acceleration.norm() + s.gamma * after.acceleration.norm())));
    EXPECT_LT((mean(s.alpha_f, before.displacement, after.displacement) - w).norm(), rounding_error(8, 2.0 * size));
    // Eqs. (d) to (g): the rates in the balance are affine in w, with the factors c_m and c_c. Each side goes through some fifteen
    // roundings.
    EXPECT_LT((mean(s.alpha_m, before.acceleration, after.acceleration) - c_m * (w - inertia_centre(s, before, h))).norm(),
              rounding_error(15 + 15, c_m * size));
    EXPECT_LT((mean(s.alpha_f, before.velocity, after.velocity) - c_c * (w - damping_centre(s, before, h))).norm(),
              rounding_error(15 + 15, c_c * size));
}

TEST_P(Scheme, IsOfSecondOrderAndUnconditionallyStable)
{
    const TimeScheme& s = GetParam();
    EXPECT_EQ(s.gamma, 0.5 - s.alpha_m + s.alpha_f);
    EXPECT_LE(s.alpha_m, s.alpha_f);
    EXPECT_LE(s.alpha_f, 0.5);
    EXPECT_GE(s.beta, 0.25 + (s.alpha_f - s.alpha_m) / 2.0);  // equal, and of exact numbers, if alpha_f = alpha_m; well above otherwise
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
