// The minimum of a function of one parameter on an interval, by GSL's implementation of Brent's method, and how well the function
// determines the parameter: a fit whose valley is flat, or whose minimum lies at a bound, reports that it found nothing.
//   const Minimum fit = minimise(misfit, 0.0, 0.4999);
//   fit.x, fit.value, fit.identifiable();
// const FittedParameter poisson = fit_over_cases(misfits, 0.0, 0.4999);   // one misfit per pose: a standard error over the poses
#pragma once

#include "analysis/statistics/statistics.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace analysis {

using Misfit = std::function<double(double parameter)>;  // any unit; NaN where it has no value

// InputError unless samples >= 3.
struct MinimiseOptions {
    int samples = 17;           // even over the interval, ends included; the deepest sample brackets the minimum that is refined
    double tolerance = 1e-5;    // tolerance on the parameter, as a share of the interval
    int iterations = 100;       // limit for Brent's method
    double perturbation = 0.1;  // relative change of the parameter in the test of identifiability
    double least_rise = 0.01;   // if the value then rises by a smaller share than this, the parameter is not identifiable
};

// Why the search ended; only converged means a minimum inside the interval.
enum class MinimumOutcome {
    converged,
    at_lower_bound,        // the smallest value lies at the end of the interval: the true minimum is there or beyond
    at_upper_bound,        // likewise at the upper end
    flat,                  // all samples are equal up to rounding
    not_finite,            // no sample is a number, or one inside the bracket is not
    iterations_exhausted,  // the bracket is still wider than the tolerance
};
const char* name_of(MinimumOutcome outcome);  // as it is spelt in the enum

// One evaluation of the function.
struct Evaluation {
    double parameter = 0.0, value = 0.0;  // the value as returned, which may be NaN
};

// x and value are the best that was found, whatever the outcome.
struct Minimum {
    MinimumOutcome outcome = MinimumOutcome::not_finite;  // why the search ended
    double x = 0.0, value = 0.0;                          // the best point evaluated; NaN if no value is a number
    double rise = 0.0;         // smallest value(x (1 +- perturbation)) / value - 1 of the sides inside the interval; infinite for value 0
    bool flat_valley = false;  // rise < least_rise
    int iterations = 0;        // iterations of Brent's method
    std::vector<Evaluation> evaluations;  // all evaluations, by increasing parameter

    // Only if this is true, x is meaningful.
    bool identifiable() const { return outcome == MinimumOutcome::converged && !flat_valley; }
};

// InputError unless low < high, both finite, and samples >= 3. Exceptions of the function are not caught.
Minimum minimise(const Misfit& function, double low, double high, const MinimiseOptions& options = {});

// One parameter fitted to several cases at once: the root mean square of their misfits is minimised.
struct FittedParameter {
    Minimum all;                  // of the root mean square over all cases
    std::vector<Minimum> cases;   // each case alone
    std::vector<double> without;  // fits to all cases but one (leave one out)
    Interval interval;            // jackknife: all.x +- Student's t (n - 1) times sqrt((n - 1) / n sum (without - their mean)^2), cut to
                                  // [low, high]; NaN bounds for fewer than two cases
};
// One misfit per case, >= 0; each is evaluated once at a parameter. level: of the interval. InputError as for minimise, and without any
// case.
FittedParameter fit_over_cases(const std::vector<Misfit>& misfits, double low, double high, const MinimiseOptions& options = {},
                               double level = 0.95);

// Work against precision: the measured points that no other point dominates, and the most precise one within a budget.
//   const std::vector<std::size_t> front = pareto_front({{0.1, 60.0}, {0.5, 25.0}, {0.7, 40.0}});   // 0, 1
//   best_within(points, 0.6);                                                                       // 1
// V. Pareto, Cours d'economie politique, 1896; work-precision diagrams: E. Hairer, G. Wanner, Solving ordinary differential equations II,
// 1996. Points whose cost or error is not finite are ignored.
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

}  // namespace analysis
