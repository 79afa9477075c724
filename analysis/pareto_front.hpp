// Work against precision: which of many measured points nothing beats, and who is nearest within a budget of time.
//   const std::vector<std::size_t> front = pareto_front({{0.1, 60.0}, {0.5, 25.0}, {0.7, 40.0}});   // 0, 1
//   best_within(points, 0.6);                                                                       // 1
// V. Pareto, Cours d'economie politique, 1896; work-precision diagrams: E. Hairer, G. Wanner, Solving ordinary differential equations II,
// 1996. A point with a cost or an error that is not finite is no candidate for anything.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace analysis {

// One measured point; less is better of both.
struct WorkPrecision {
    double cost = 0.0;   // of any unit, the same for all points
    double error = 0.0;  // of any unit, the same for all points
};

// a is nowhere worse than b and somewhere better.
bool dominates(const WorkPrecision& a, const WorkPrecision& b);

// The points that none dominates, by cost and, where costs are equal, in their own order: points equal in both are on it together.
std::vector<std::size_t> pareto_front(const std::vector<WorkPrecision>& points);

// The point of the least error among those that cost no more than the budget; of equal ones the cheapest, then the first. Nothing where
// none is so cheap.
std::optional<std::size_t> best_within(const std::vector<WorkPrecision>& points, double budget);

// From which budget on the best of `one` has a smaller error than the best of `other`.
struct Crossing {
    double from = 0.0;            // the least budget beyond which it is always so
    std::size_t one = 0;          // the best of `one` at `from`
    double other_error = 0.0;     // of the best of `other` at `from`; infinite where none is so cheap
    bool from_the_start = false;  // at no budget that either can be had for was the other the nearer
};
// Nothing where, however large the budget, the best of `one` is not the nearer.
std::optional<Crossing> nearer_from(const std::vector<WorkPrecision>& one, const std::vector<WorkPrecision>& other);

}  // namespace analysis
