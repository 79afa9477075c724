// Reference: series made from the formula, with and without noise of a known size.
#include "analysis/damped_oscillation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

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

// Three seconds at 100 Hz. The fit ends at a step of 1e-10 of each parameter, and without noise the error that remains is far smaller than
// the last step. The damping ratio is a quotient of two parameters.
TEST(DampedOscillation, FrequencyAndDampingComeBack)
{
    for (const double frequency_hz : {1.0, 4.0, 11.0})
        for (const double damping_ratio : {0.005, 0.05, 0.3}) {
            const auto swing = fit_damped_oscillation(oscillation(frequency_hz, damping_ratio), 0.01);
            ASSERT_EQ(swing.outcome, OscillationOutcome::found) << frequency_hz << " " << damping_ratio;
            EXPECT_NEAR(swing.frequency_hz.estimate, frequency_hz, 1e-10 * frequency_hz);
            EXPECT_NEAR(swing.damping_ratio.estimate, damping_ratio, 2.0 * 1e-10 * damping_ratio);
            EXPECT_NEAR(swing.amplitude, 1.0, 1e-10);
        }
}

// With white noise the 95 % interval contains the true value in 95 of 100 series; fewer than 85 would occur once in 30,000 times
// (binomial).
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
TEST(DampedOscillation, OneThatDiesAtOnceIsTooShort)
{
    EXPECT_EQ(fit_damped_oscillation(oscillation(25.0, 0.3), 0.01).outcome, OscillationOutcome::too_short);
}

TEST(DampedOscillation, ACreepIsOverdamped)
{
    std::vector<double> series;
    for (int i = 0; i < 300; ++i) series.push_back(std::exp(-0.03 * i));
    EXPECT_EQ(fit_damped_oscillation(series, 0.01).outcome, OscillationOutcome::overdamped);
}

TEST(DampedOscillation, StillnessShortnessAndNoiseAreNone)
{
    EXPECT_EQ(fit_damped_oscillation({}, 0.01).outcome, OscillationOutcome::none);
    EXPECT_EQ(fit_damped_oscillation(std::vector<double>(50, 3.0), 0.01).outcome, OscillationOutcome::none);
    EXPECT_EQ(fit_damped_oscillation({1.0, std::nan(""), 2.0}, 0.01).outcome, OscillationOutcome::none);
    std::vector<double> one_kick(100, 0.0);
    one_kick[0] = 1.0;
    EXPECT_EQ(fit_damped_oscillation(one_kick, 0.01).outcome, OscillationOutcome::too_short);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::vector<double> noise(300);
    for (double& y : noise) y = normal(random);
    EXPECT_EQ(fit_damped_oscillation(noise, 0.01).outcome, OscillationOutcome::unclear);
}

}  // namespace
