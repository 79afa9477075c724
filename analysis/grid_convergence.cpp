#include "analysis/grid_convergence.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace analysis {
namespace {

void require(bool holds, const char* field, double value, const std::string& rule)
{
    if (!holds) throw pbs::InputError("", 0, field, fmt::format("{}", value), rule);
}

// f1 + (f1 - f2) / (r^p - 1)
double richardson(double fine, double coarse, double ratio, double order)
{
    return fine + (fine - coarse) / (std::pow(ratio, order) - 1.0);
}

}  // namespace

GridConvergence two_grids(const std::array<double, 2>& values, double ratio, double order)
{
    require(ratio >= smallest_grid_ratio && std::isfinite(ratio), "ratio of mesh sizes", ratio,
            fmt::format("expected >= {}", smallest_grid_ratio));
    require(order > 0.0 && std::isfinite(order), "order of convergence", order, "expected > 0");
    const double limit = richardson(values[0], values[1], ratio, order);
    return {limit, {grid_safety_factor * std::abs(values[0] - limit), grid_safety_factor * std::abs(values[1] - limit)}};
}

GridConvergence two_fields(double difference, double ratio, double order)
{
    GridConvergence convergence = two_grids({0.0, difference}, ratio, order);
    convergence.extrapolated = std::numeric_limits<double>::quiet_NaN();
    return convergence;
}

}  // namespace analysis
