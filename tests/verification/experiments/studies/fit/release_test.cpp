// Reference: the closed form of the recurrence. Along an eigenvector of the step matrix S with the real eigenvalue s, Algorithm 1 is
//   x(t+1) = s (2 x(t) - x(t-1)),  z^2 - 2 s z + s = 0,  z = s +- i sqrt(s (1 - s)):
// it swings by acos(sqrt s) per step and keeps sqrt(s) of its amplitude. Damped cosines with a known frequency are the other reference.
#include "experiments/studies/fit/release_test.hpp"

#include "tests/support/hanging_tet.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace experiments;
using test_support::rounding_error;

std::vector<double> damped_cosine(double frequency_hz, double damping_ratio, double dt_s, int samples)
{
    std::vector<double> signal;
    const double omega = 2.0 * std::numbers::pi * frequency_hz, decay = damping_ratio / std::sqrt(1.0 - damping_ratio * damping_ratio);
    for (int i = 0; i < samples; ++i) signal.push_back(std::exp(-decay * omega * i * dt_s) * std::cos(omega * i * dt_s));
    return signal;
}

// Errors relative to the frequency, and of the damping ratio, of a swing by `angle` = omega dt per sample. Linear interpolation at a
// crossing has an error of at most angle^3 / 16 of a radian, plus d angle / 4 where the amplitude falls by d per sample; two crossings
// limit the half periods of pi. A peak between samples is low by angle^2 / 8, and the damping is the logarithm of a ratio of two peaks over
// pi.
struct SwingError {
    double frequency, damping_ratio;
};

SwingError swing_error(double angle, double damping_ratio, int half_periods)
{
    const double decay = angle * damping_ratio / std::sqrt(1.0 - damping_ratio * damping_ratio);
    return {2.0 * (angle * angle * angle / 16.0 + decay * angle / 4.0) / (half_periods * std::numbers::pi),
            (angle * angle + decay * decay) / 8.0 / (half_periods - 1) / std::numbers::pi};
}

TEST(ReleaseTest, MeasuresADampedCosine)
{
    const double dt_s = 0.01, f = 1.3;
    for (const double damping_ratio : {0.0, 0.01, 0.1}) {
        const auto test = measure_swing(damped_cosine(f, damping_ratio, dt_s, 400), dt_s);
        ASSERT_EQ(test.outcome, SwingOutcome::finished);
        EXPECT_EQ(test.half_periods, 9);
        const SwingError error = swing_error(2.0 * std::numbers::pi * f * dt_s, damping_ratio, 9);
        EXPECT_NEAR(test.frequency_hz, f, error.frequency * f);
        EXPECT_NEAR(test.damping_ratio, damping_ratio, error.damping_ratio);
        const double undamped_hz = f / std::sqrt(1.0 - damping_ratio * damping_ratio), highest_ratio = damping_ratio + error.damping_ratio;
        EXPECT_NEAR(test.undamped_hz, undamped_hz,
                    undamped_hz * (error.frequency + highest_ratio * error.damping_ratio / (1.0 - highest_ratio * highest_ratio)));
    }
}

TEST(ReleaseTest, SaysThatNothingSwings)
{
    std::vector<double> fading;
    for (int i = 0; i < 100; ++i) fading.push_back(std::exp(-0.1 * i));
    EXPECT_EQ(measure_swing(fading, 0.01).outcome, SwingOutcome::no_crossing);
    fading[50] = std::nan("");
    EXPECT_EQ(measure_swing(fading, 0.01).outcome, SwingOutcome::not_finite);
}

TEST(ReleaseTest, HangingParticleSwingsByTheEigenvalueOfItsStep)
{
    const auto tet = test_support::hanging_tet();
    const double k_stretch = 0.01, dt_s = 0.01;
    const Eigen::Matrix3d S = test_support::step_matrix(tet, 1, k_stretch);
    pbs::Vec3 direction(1.0, 2.0, 3.0);  // the slowest mode, by the power method
    for (int i = 0; i < 20000; ++i) direction = (S * direction).normalized();
    const double s = direction.dot(S * direction);
    ASSERT_LT((S * direction - s * direction).norm(), std::sqrt(3.0) * rounding_error(2 * (3 + 3), 1.0));  // products with rows, and norms

    pbs::Positions displacement = pbs::Positions::Zero(4, 3);
    displacement.row(3) = 1e-6 * direction.transpose();
    const auto test = release({tet.mesh, tet.held, test_support::stretch_alone(1, k_stretch), displacement, direction, {3}}, dt_s, 6);
    ASSERT_EQ(test.outcome, SwingOutcome::finished);
    const double angle = std::acos(std::sqrt(s)), decay = -std::log(s) / 2.0;
    const double damping_ratio = decay / std::hypot(angle, decay);
    const SwingError error = swing_error(angle, damping_ratio, test.half_periods);
    EXPECT_NEAR(test.frequency_hz, angle / (2.0 * std::numbers::pi * dt_s), error.frequency * test.frequency_hz);
    EXPECT_NEAR(test.damping_ratio, damping_ratio, error.damping_ratio);
    EXPECT_NEAR(test.undamped_hz, std::hypot(angle, decay) / (2.0 * std::numbers::pi * dt_s),
                test.undamped_hz * (error.frequency + 1.1 * damping_ratio * error.damping_ratio));
}

}  // namespace
