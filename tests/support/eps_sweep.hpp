// Verifies a gradient: the central difference along a direction has an error of O(eps^2), so the error must fall a
// hundredfold when eps falls tenfold, until rounding dominates. A wrong gradient leaves an error that does not depend
// on eps.
#pragma once

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace test_support {

// value(x): the function; x: its argument; size: its length scale, the unit of eps; direction: same shape as x, entries
// of order one.
template <typename Value>
void expect_slope_by_eps_sweep(Value value, const Eigen::VectorXd& x, const Eigen::VectorXd& direction, double slope,
                               double size)
{
    const double magnitude = std::abs(slope) * size + std::abs(value(x));
    double previous_error = 0.0;
    int observed_orders = 0;
    for (const double eps : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        const double h = eps * size;
        const double error = std::abs((value(x + h * direction) - value(x - h * direction)) / (2.0 * h) - slope);
        const double rounding = 100.0 * std::numeric_limits<double>::epsilon() * magnitude / h;
        if (previous_error > 0.0 && error > rounding) {
            EXPECT_NEAR(std::log10(previous_error / error), 2.0, 0.3) << "eps " << eps << " error " << error;
            ++observed_orders;
        } else if (previous_error > 0.0) {
            EXPECT_LE(error, rounding) << "eps " << eps;
        }
        previous_error = error > rounding ? error : 0.0;
    }
    EXPECT_GE(observed_orders, 1) << "the sweep never saw the error fall";
}

}  // namespace test_support
