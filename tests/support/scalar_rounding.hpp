// The rounding error of numbers in float or double, for tolerances of tests that run in both precisions (rounding_error.hpp).
#pragma once

#include <limits>

namespace test_support {

// In the unit of the magnitude.
template <typename Scalar>
constexpr double rounding_error_in(double roundings, double magnitude)
{
    return roundings * (double(std::numeric_limits<Scalar>::epsilon()) / 2.0) * magnitude;
}

}  // namespace test_support
