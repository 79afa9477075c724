// Reference: the closed form of the recurrence, evaluated for one eigenvalue, and its limits.
#include "experiments/studies/fit/bar_runs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace {

using experiments::frequency_over_sag;

TEST(FrequencyOverSag, IsOneForSmallSteps)
{
    EXPECT_NEAR(frequency_over_sag(1e-4), 1.0, 1e-7);
    EXPECT_LT(frequency_over_sag(0.5), frequency_over_sag(0.1));
}

// s = 0.9: at rest x = a dt^2 s / (1 - s), so (omega dt)^2 = 1 / 9; in time the roots of z^2 - 2 s z + s give |log z| per step.
TEST(FrequencyOverSag, OfOneEigenvalue)
{
    const double s = 0.9;
    const std::complex<double> z(s, std::sqrt(s * (1.0 - s)));
    EXPECT_NEAR(frequency_over_sag(1.0 / 3.0), std::norm(std::log(z)) * 9.0, 1e-12);
}

}  // namespace
