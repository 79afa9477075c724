// Straight lines through data by least squares (GSL), and observed orders of convergence as slopes on log-log axes.
//   const Interval order = observed_order(mesh_size_m, error_l2_pct).slope;   // 2.02 [1.97, 2.07]
#pragma once

#include "analysis/bootstrap.hpp"

#include <vector>

namespace analysis {

// y = intercept + slope x. Intervals by Student's t with n - 2 degrees of freedom; NaN bounds for two points.
struct LineFit {
    Interval slope, intercept;  // in y / x and y
    double residual_rms = 0.0;  // sqrt(sum of squared residuals / n)
};

// InputError unless x and y have the same size, at least two, and the values of x differ.
LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y, double level = 0.95);

// error = c h^p: p is the slope, log c the intercept. InputError unless all values are positive.
LineFit observed_order(const std::vector<double>& h, const std::vector<double>& error, double level = 0.95);

}  // namespace analysis
