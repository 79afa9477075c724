#include "analysis/statistics/grid_convergence.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
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

constexpr double lowest_order = 0.5, above_formal = 0.1;
constexpr double reliable_factor = 1.25, other_factor = 3.0;

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

NestedOrder nested_order(const NestedDistances& distances, double formal_order)
{
    NestedOrder order;
    order.observed = std::log2(distances.linear / distances.linear_refined);
    order.order =
        std::isnan(order.observed) ? formal_order : std::clamp(order.observed, std::min(lowest_order, formal_order), formal_order);
    order.reliable =
        order.observed >= lowest_order && order.observed <= formal_order + above_formal && distances.quadratic < distances.linear_refined;
    order.safety_factor = order.reliable ? reliable_factor : other_factor;
    return order;
}

NestedOrder order_without_finest(double linear, double linear_refined, double formal_order)
{
    NestedOrder order = nested_order({linear, linear_refined, 0.0}, formal_order);
    order.reliable = false;
    order.safety_factor = other_factor;
    return order;
}

double NestedOrder::bound(double quadratic) const
{
    return safety_factor * quadratic / (std::exp2(order) - 1.0);
}

pbs::Positions extrapolated(const pbs::Positions& refined, const pbs::Positions& unrefined, double order)
{
    return refined + (refined - unrefined) / (std::exp2(order) - 1.0);
}

}  // namespace analysis
