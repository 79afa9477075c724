// Reference: the closed form of the recurrence, evaluated for one eigenvalue, and its limits.
#include "experiments/studies/fit/bar_runs.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace {

using experiments::frequency_over_sag;

// s = 1 / (1 + x^2) and |log z|^2 / x^2 = (arctan(x)^2 + log(1 + x^2)^2 / 4) / x^2 = 1 - 5 / 12 x^2 + O(x^4). The number sqrt(s) near 1
// is in error by three roundings, and its arc cosine, which is near x, by as much over x; it enters as a square over x^2.
TEST(FrequencyOverSag, IsOneForSmallSteps)
{
    for (const double x : {1e-2, 1e-3, 1e-4})
        EXPECT_NEAR(frequency_over_sag(x), 1.0 - 5.0 / 12.0 * x * x, std::pow(x, 4) + test_support::rounding_error(2 * 3, 1.0 / (x * x)))
            << x;
    EXPECT_LT(frequency_over_sag(0.5), frequency_over_sag(0.1));
}

// s = 0.9: at rest x = a dt^2 s / (1 - s), so (omega dt)^2 = 1 / 9; in time the roots of z^2 - 2 s z + s give |log z| per step.
TEST(FrequencyOverSag, OfOneEigenvalue)
{
    const double s = 0.9;
    const std::complex<double> z(s, std::sqrt(s * (1.0 - s)));
    // The arc cosine and the logarithm have condition numbers below ten here, for arguments of at most four roundings. Ten more follow; all
    // count twice in a square, on each side.
    const double expected = std::norm(std::log(z)) * 9.0;
    EXPECT_NEAR(frequency_over_sag(1.0 / 3.0), expected, test_support::rounding_error(2 * 2 * (10 * 4 + 10), expected));
}

}  // namespace
