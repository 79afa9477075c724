// The rounding error of slopes of fitted lines, for tolerances. The slope of points (x, y) on a line is sum (x - mean) y / S, where S = sum
// (x - mean)^2. Errors e_x and e_y of the points change it by at most (e_y + |slope| e_x) sum |x - mean| / S, which is at most
// (e_y + |slope| e_x) sqrt(n / S). Each coordinate goes through n + 1 roundings of its mean and difference; the two sums have terms of one
// sign, of which each goes through three for each of the points.
#pragma once

#include "tests/support/rounding_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace test_support {

// x and y may be in error by so much themselves.
inline double slope_error(const std::vector<double>& x, const std::vector<double>& y, double slope, double x_error = 0.0,
                          double y_error = 0.0)
{
    const double n = static_cast<double>(x.size()), mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double squares = 0.0, largest_x = 0.0, largest_y = 0.0;
    for (const double value : x) squares += (value - mean) * (value - mean), largest_x = std::max(largest_x, std::abs(value));
    for (const double value : y) largest_y = std::max(largest_y, std::abs(value));
    const double of_points = y_error + rounding_error(n + 1, largest_y) + std::abs(slope) * (x_error + rounding_error(n + 1, largest_x));
    return of_points * std::sqrt(n / squares) + rounding_error(6 * n + 1, std::abs(slope));
}

// The rounding error of the exponent of a power law. It is the slope between logarithms of two roundings each; y goes through so many
// roundings itself.
inline double exponent_error(std::vector<double> x, std::vector<double> y, double exponent, double roundings_of_y)
{
    double of_x = 0.0, of_y = rounding_error(roundings_of_y, 1.0);
    for (double& value : x) value = std::log(value), of_x = std::max(of_x, rounding_error(2, std::abs(value)));
    for (double& value : y)
        value = std::log(value), of_y = std::max(of_y, rounding_error(2, std::abs(value)) + rounding_error(roundings_of_y, 1.0));
    return slope_error(x, y, exponent, of_x, of_y);
}

}  // namespace test_support
