// Bounds of rounding errors, for tolerances. A sum of products of which each goes through at most n roundings is in error by at most n
// times the unit roundoff, eps / 2, times the sum of their magnitudes (N. Higham, Accuracy and stability of numerical algorithms, 2nd ed.,
// SIAM 2002, Sec. 3.1). n counts the sums as well, and both sides of a comparison where both are rounded.
#pragma once

#include <cstddef>
#include <limits>

namespace test_support {

// In the unit of the magnitude.
constexpr double rounding_error(double roundings, double magnitude)
{
    return roundings * (std::numeric_limits<double>::epsilon() / 2.0) * magnitude;
}

// The rounding error of the mean of so many values of one sign, each of which is rounded.
constexpr double mean_error(std::size_t values, double mean)
{
    return rounding_error(1.0 + static_cast<double>(values), mean);
}

}  // namespace test_support
