#include "analysis/line_fit.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

void require_points_for_a_line(const std::vector<double>& x, const std::vector<double>& y)
{
    if (x.size() != y.size() || x.size() < 2)
        throw pbs::InputError("", 0, "points of a line fit", fmt::format("{} x, {} y", x.size(), y.size()), "expected as many, at least 2");
    const auto [least, most] = std::minmax_element(x.begin(), x.end());
    if (!(*least < *most)) throw pbs::InputError("", 0, "x of a line fit", fmt::format("{}", *least), "expected values that differ");
}

Interval student_interval(double estimate, double variance, double level, std::size_t n)
{
    double half_width = std::numeric_limits<double>::quiet_NaN();
    if (n > 2) half_width = gsl_cdf_tdist_Pinv((1.0 + level) / 2.0, static_cast<double>(n - 2)) * std::sqrt(variance);
    return {estimate, estimate - half_width, estimate + half_width, level, static_cast<int>(n), 0};
}

std::vector<double> logarithms(std::vector<double> values, const char* name)
{
    for (double& value : values) {
        if (!(value > 0.0)) throw pbs::InputError("", 0, name, fmt::format("{}", value), "expected > 0");
        value = std::log(value);
    }
    return values;
}

}  // namespace

LineFit fit_line(const std::vector<double>& x, const std::vector<double>& y, double level)
{
    require_points_for_a_line(x, y);
    double intercept, slope, var_intercept, covariance, var_slope, squares;
    gsl_fit_linear(x.data(), 1, y.data(), 1, x.size(), &intercept, &slope, &var_intercept, &covariance, &var_slope, &squares);
    return {student_interval(slope, var_slope, level, x.size()), student_interval(intercept, var_intercept, level, x.size()),
            std::sqrt(squares / static_cast<double>(x.size()))};
}

LineFit observed_order(const std::vector<double>& h, const std::vector<double>& error, double level)
{
    return fit_line(logarithms(h, "h"), logarithms(error, "error"), level);
}

}  // namespace analysis
