#include "analysis/nested_convergence.hpp"

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

constexpr double lowest_order = 0.5, above_formal = 0.1;
constexpr double reliable_factor = 1.25, other_factor = 3.0;

}  // namespace

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
