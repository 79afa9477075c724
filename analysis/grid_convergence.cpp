#include "analysis/grid_convergence.hpp"

#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace analysis {
namespace {

constexpr double two_grid_factor = 3.0, three_grid_factor = 1.25, no_limit_factor = 3.0;
constexpr double asymptotic_tolerance = 0.1;  // relative to the order
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

void require(bool holds, const char* field, double value, const char* rule)
{
    if (!holds) throw pbs::InputError("", 0, field, fmt::format("{}", value), rule);
}

void require_ratio_and_order(double ratio, double order)
{
    require(ratio > 1.0 && std::isfinite(ratio), "ratio of mesh sizes", ratio, "expected > 1");
    require(order > 0.0 && std::isfinite(order), "order of convergence", order, "expected > 0");
}

// f1 + (f1 - f2) / (r^p - 1)
double richardson(double fine, double coarse, double ratio, double order)
{
    return fine + (fine - coarse) / (std::pow(ratio, order) - 1.0);
}

// The function whose root is p, for |R|, a = ln r32 and b = ln r21. It increases with p in both cases, so there is one root.
struct OrderEquation {
    double log_ratio, a, b;
    bool oscillating;

    double operator()(double p) const
    {
        // R = r21^p (r32^p + 1) / (r21^p + 1)   [Celik's with s = -1]
        if (oscillating) return b * p + std::log1p(std::exp(a * p)) - std::log1p(std::exp(b * p)) - log_ratio;
        // R = r21^p (r32^p - 1) / (r21^p - 1)
        const double both = p == 0.0 ? a / b : std::expm1(a * p) / -std::expm1(-b * p);
        return std::log(both) - log_ratio;
    }
};

double root_of(const OrderEquation& equation, double lower, double upper)
{
    gsl_function function;
    function.function = [](double p, void* parameters) { return (*static_cast<const OrderEquation*>(parameters))(p); };
    function.params = const_cast<OrderEquation*>(&equation);
    const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(gsl_root_fsolver_alloc(gsl_root_fsolver_brent),
                                                                                gsl_root_fsolver_free);
    gsl_root_fsolver_set(solver.get(), &function, lower, upper);
    for (int iteration = 0; iteration < 200; ++iteration) {
        gsl_root_fsolver_iterate(solver.get());
        if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver.get()), gsl_root_fsolver_x_upper(solver.get()), 1e-13, 1e-13) ==
            GSL_SUCCESS)
            break;
    }
    return gsl_root_fsolver_root(solver.get());
}

GridBehaviour behaviour_of(double fine_difference, double coarse_difference, double order)
{
    if (!std::isfinite(fine_difference) || !std::isfinite(coarse_difference)) return GridBehaviour::not_finite;
    if (fine_difference == 0.0 && coarse_difference == 0.0) return GridBehaviour::constant;
    if (fine_difference * coarse_difference < 0.0) return GridBehaviour::oscillating;
    return order > 0.0 ? GridBehaviour::monotone : GridBehaviour::diverging;
}

bool has_limit(GridBehaviour behaviour)
{
    return behaviour == GridBehaviour::monotone || behaviour == GridBehaviour::presumed || behaviour == GridBehaviour::constant;
}

// Sets the bounds of all grids from their values, the finest first.
void set_limit_and_bounds(GridConvergence& convergence, const std::vector<double>& values, double ratio)
{
    convergence.extrapolated = unknown;
    if (has_limit(convergence.behaviour)) {
        convergence.extrapolated = richardson(values[0], values[1], ratio, convergence.order);
        for (const double value : values)
            convergence.bounds.push_back(convergence.safety_factor * std::abs(value - convergence.extrapolated));
        return;
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double range = convergence.behaviour == GridBehaviour::not_finite ? unknown : *most - *least;
    convergence.safety_factor = no_limit_factor;
    convergence.bounds.assign(values.size(), no_limit_factor * range);
}

}  // namespace

const char* name_of(GridBehaviour behaviour)
{
    static constexpr const char* names[] = {"presumed", "monotone", "oscillating", "diverging", "constant", "not_finite"};
    return names[static_cast<int>(behaviour)];
}

double observed_order_of_three(double difference_ratio, const std::array<double, 2>& ratios)
{
    for (const double ratio : ratios) require_ratio_and_order(ratio, 1.0);
    if (std::isnan(difference_ratio)) return unknown;
    const double b = std::log(ratios[0]), a = std::log(ratios[1]), log_ratio = std::log(std::abs(difference_ratio));
    if (a == b || !std::isfinite(log_ratio)) return log_ratio / b;  // p = ln |R| / ln r
    const OrderEquation equation{log_ratio, a, b, difference_ratio < 0.0};
    const double farthest = 600.0 / std::max(a, b);  // beyond this, exp would overflow
    if (equation(farthest) <= 0.0) return std::numeric_limits<double>::infinity();
    if (equation(-farthest) >= 0.0) return -std::numeric_limits<double>::infinity();
    return root_of(equation, -farthest, farthest);
}

GridConvergence two_grids(const std::array<double, 2>& values, double ratio, double order)
{
    require_ratio_and_order(ratio, order);
    GridConvergence convergence{GridBehaviour::presumed, unknown, order, two_grid_factor, unknown, {}, false};
    if (!std::isfinite(values[0] - values[1])) convergence.behaviour = GridBehaviour::not_finite;
    set_limit_and_bounds(convergence, {values[0], values[1]}, ratio);
    return convergence;
}

GridConvergence three_grids(const std::array<double, 3>& values, const std::array<double, 2>& ratios, double formal_order)
{
    for (const double ratio : ratios) require_ratio_and_order(ratio, formal_order);
    const double fine_difference = values[1] - values[0], coarse_difference = values[2] - values[1];
    GridConvergence convergence;
    convergence.observed_order = observed_order_of_three(coarse_difference / fine_difference, ratios);
    convergence.behaviour = behaviour_of(fine_difference, coarse_difference, convergence.observed_order);
    const bool monotone = convergence.behaviour == GridBehaviour::monotone;
    convergence.order = monotone ? std::min(convergence.observed_order, formal_order) : formal_order;
    convergence.safety_factor = three_grid_factor;
    convergence.asymptotic = monotone && std::abs(convergence.observed_order - formal_order) <= asymptotic_tolerance * formal_order;
    set_limit_and_bounds(convergence, {values[0], values[1], values[2]}, ratios[0]);
    return convergence;
}

GridConvergence two_fields(double difference, double ratio, double order)
{
    GridConvergence convergence = two_grids({0.0, difference}, ratio, order);
    convergence.extrapolated = unknown;
    return convergence;
}

}  // namespace analysis
