// Reference: the theory of beams and of damped oscillators.
#include "reference_fem/dynamics/vibrating_body.hpp"

#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;

const double pi = std::acos(-1.0);

bool at_x_0(const pbs::Vec3& x)
{
    return x.x() < 1e-9;
}

// Bernoulli-Euler: omega = 1.875104^2 sqrt(E I / (rho A L^4)). Rayleigh's quotient over that mode, for which the integrals of w'^2 over w^2
// and of w'''^2 over w''^2 are both 4.647 / L^2, gives the reduction by rotary inertia and shear: 4.647 (r / L)^2 (1 + E / (k G)) / 2, with
// r^2 = h^2 / 12 and E / (k G) = 12 / 5 for nu = 0. The remaining errors are its square, 4e-5, and that of the elements, 1e-4 on this mesh.
TEST(FirstFrequency, OfQuadraticTetsIsThatOfABeam)
{
    const VibratingBody bar(test_support::structured_bar({0, 0, 0}, {1, 0.1, 0.1}, {20, 2, 2}), {.poisson = 0.0, .held = at_x_0});
    const double bernoulli_euler_rad_s = 3.516015269 * std::sqrt(1e5 * 1e-4 / 12.0 / (1000.0 * 1e-2));
    const double ratio = bar.first_mode().omega_rad_s / bernoulli_euler_rad_s;
    RecordProperty("over_bernoulli_euler", std::to_string(ratio));
    EXPECT_NEAR(ratio, 1.0 - 4.647 / 1200.0 * (1.0 + 2.4) / 2.0, 3e-4);
}

// A bar released in its first mode crosses zero every half period.
TEST(FirstFrequency, OfTimeIntegrationIsTheEigenvalue)
{
    VibratingBody bar(test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {6, 1, 1}), {.held = at_x_0});
    const Mode mode = bar.first_mode();
    TimeStepper stepper = bar.stepper({});
    stepper.start(mode.shape);
    const double h = 0.1 / mode.omega_rad_s;
    std::vector<double> crossings;
    double before = 1.0;
    ASSERT_TRUE(bar.run(stepper, h, 260, [&](int k) {
        const double amplitude = bar.amplitude(stepper, mode);
        if (before * amplitude < 0.0) crossings.push_back((k - amplitude / (amplitude - before)) * h);
        before = amplitude;
    }));
    ASSERT_GE(crossings.size(), 8u);
    const double half_period_s = (crossings.back() - crossings.front()) / (crossings.size() - 1.0);
    // Average acceleration lengthens the period by (omega h)^2 / 12 (Hughes, ch. 9); the interpolation of a crossing has an error of (omega
    // h)^3 / 8 / 6.
    EXPECT_NEAR(half_period_s * mode.omega_rad_s / pi, 1.0 + 0.01 / 12.0, 5e-5);
}

// zeta = (a / omega + b omega) / 2, from the ratio of two maxima a period apart: the logarithmic decrement 2 pi zeta / sqrt(1 - zeta^2).
class RayleighDamping : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(RayleighDamping, OfTheFirstModeIsTheDampingRatioOfTheory)
{
    VibratingBody bar(test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {6, 1, 1}), {.element_order = 1, .held = at_x_0});
    const Mode mode = bar.first_mode();
    const auto [of_mass, of_stiffness] = GetParam();
    const double a = 2.0 * of_mass * mode.omega_rad_s, b = 2.0 * of_stiffness / mode.omega_rad_s, zeta = of_mass + of_stiffness;
    TimeStepper stepper = bar.stepper({.rayleigh_mass_1_s = a, .rayleigh_stiffness_s = b});
    stepper.start(mode.shape);
    const int steps_a_period = 100;
    const double omega_d = mode.omega_rad_s * std::sqrt(1.0 - zeta * zeta);
    ASSERT_TRUE(bar.run(stepper, 2.0 * pi / omega_d / steps_a_period, steps_a_period));
    const double one = bar.amplitude(stepper, mode);
    ASSERT_TRUE(bar.run(stepper, 2.0 * pi / omega_d / steps_a_period, steps_a_period));
    const double decrement = std::log(one / bar.amplitude(stepper, mode));
    const double measured = decrement / std::hypot(2.0 * pi, decrement);
    RecordProperty("measured_damping_ratio", std::to_string(measured));
    // Second order in omega h = 0.063: 4e-3 / 12, doubled for the phase by which the maximum is missed.
    EXPECT_NEAR(measured, zeta, 2e-3 * zeta);
}

INSTANTIATE_TEST_SUITE_P(Parts, RayleighDamping, testing::Values(std::pair(0.05, 0.0), std::pair(0.0, 0.05), std::pair(0.02, 0.03)));

}  // namespace
