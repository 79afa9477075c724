// Work against precision: the measured points that no other point dominates, and the most precise one within a budget.
//   const std::vector<std::size_t> front = pareto_front({{0.1, 60.0}, {0.5, 25.0}, {0.7, 40.0}});   // 0, 1
//   best_within(points, 0.6);                                                                       // 1
// V. Pareto, Cours d'economie politique, 1896; work-precision diagrams: E. Hairer, G. Wanner, Solving ordinary differential equations II,
// 1996. Points whose cost or error is not finite are ignored.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace analysis {

// One measured point; less is better for both members.
struct WorkPrecision {
    double cost = 0.0;   // any unit, the same for all points
    double error = 0.0;  // any unit, the same for all points
};

// True if a is nowhere worse than b and somewhere better.
bool dominates(const WorkPrecision& a, const WorkPrecision& b);

// The points that none dominates, by cost and, for equal costs, in their given order; points that are equal in both are on the front
// together.
std::vector<std::size_t> pareto_front(const std::vector<WorkPrecision>& points);

// The point with the smallest error among those whose cost is within the budget; among equal ones the cheapest, then the first. Nothing if
// no point is within the budget.
std::optional<std::size_t> best_within(const std::vector<WorkPrecision>& points, double budget);

// The budget from which on the best point of `one` has a smaller error than the best of `other`.
struct Crossing {
    double from = 0.0;            // the smallest budget beyond which this always holds
    std::size_t one = 0;          // the best of `one` at `from`
    double other_error = 0.0;     // error of the best of `other` at `from`; infinite if none is within that budget
    bool from_the_start = false;  // true if `other` is better at no budget at which either has a point
};
// Nothing if the best of `one` is not better at arbitrarily large budgets.
std::optional<Crossing> nearer_from(const std::vector<WorkPrecision>& one, const std::vector<WorkPrecision>& other);

}  // namespace analysis
