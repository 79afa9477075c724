#include "analysis/pareto_front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace analysis {
namespace {

bool is_candidate(const WorkPrecision& point)
{
    return std::isfinite(point.cost) && std::isfinite(point.error);
}

double error_within(const std::vector<WorkPrecision>& points, double budget)
{
    const auto best = best_within(points, budget);
    return best ? points[*best].error : std::numeric_limits<double>::infinity();
}

}  // namespace

bool dominates(const WorkPrecision& a, const WorkPrecision& b)
{
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

std::vector<std::size_t> pareto_front(const std::vector<WorkPrecision>& points)
{
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto beats = [&](const WorkPrecision& other) { return is_candidate(other) && dominates(other, points[i]); };
        if (is_candidate(points[i]) && std::none_of(points.begin(), points.end(), beats)) front.push_back(i);
    }
    std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; });
    return front;
}

std::optional<std::size_t> best_within(const std::vector<WorkPrecision>& points, double budget)
{
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_candidate(points[i]) && points[i].cost <= budget &&
            (!best || dominates(points[i], points[*best]) || points[i].error < points[*best].error))
            best = i;
    return best;
}

std::optional<Crossing> nearer_from(const std::vector<WorkPrecision>& one, const std::vector<WorkPrecision>& other)
{
    std::vector<double> budgets;  // the budgets at which the best point of either set changes
    for (const auto* points : {&one, &other})
        for (const WorkPrecision& point : *points)
            if (is_candidate(point)) budgets.push_back(point.cost);
    std::sort(budgets.begin(), budgets.end());
    std::optional<Crossing> crossing;
    bool other_was_nearer = false;
    for (const double budget : budgets) {
        const bool nearer = error_within(one, budget) < error_within(other, budget);
        if (nearer && !crossing) crossing = Crossing{budget, *best_within(one, budget), error_within(other, budget), !other_was_nearer};
        if (!nearer) crossing.reset();
        other_was_nearer |= !nearer;
    }
    return crossing;
}

}  // namespace analysis
