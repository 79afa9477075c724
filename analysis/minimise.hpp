// The least value of a function of one parameter on an interval, by GSL's minimiser of Brent, and how well the function tells the
// parameter: a fit whose valley is flat or lies at a bound has found nothing, and says so.
//   const Minimum fit = minimise(misfit, 0.0, 0.4999);
//   fit.x, fit.value, fit.identifiable();
//   const FittedParameter poisson = fit_over_cases(misfits, 0.0, 0.4999);   // one misfit a pose: a standard error over the poses
#pragma once

#include "analysis/bootstrap.hpp"

#include <functional>
#include <vector>

namespace analysis {

using Misfit = std::function<double(double parameter)>;  // any unit; not a number where it has no value

// samples >= 3, else InputError.
struct MinimiseOptions {
    int samples = 17;           // evenly over the interval, ends included: the deepest one brackets the minimum that is taken
    double tolerance = 1e-5;    // of the parameter, as a share of the interval
    int iterations = 100;       // of Brent's method
    double perturbation = 0.1;  // the parameter is changed by this share of itself, and
    double least_rise = 0.01;   // where the value then rises by less than this share of itself, the parameter is not identifiable
};

// Why the search ended; only converged has a minimum inside.
enum class MinimumOutcome {
    converged,
    at_lower_bound,        // the deepest value lies at the end of the interval: the true minimum is there or beyond
    at_upper_bound,        // the same at the other end
    flat,                  // all samples are equal but for rounding
    not_finite,            // no sample is a number, or one inside the bracket is not
    iterations_exhausted,  // the bracket is still wider than the tolerance
};
const char* name_of(MinimumOutcome outcome);  // as it is spelt in the enum

// A point that the function was asked at.
struct Evaluation {
    double parameter = 0.0, value = 0.0;  // the value as it came, NaN too
};

// x and value are the best there is, whatever the outcome.
struct Minimum {
    MinimumOutcome outcome = MinimumOutcome::not_finite;  // why it ended
    double x = 0.0, value = 0.0;                          // the best point evaluated; NaN where none was a number
    double rise = 0.0;  // least of value(x (1 +- perturbation)) / value - 1, over the sides inside the interval; infinite for value 0
    bool flat_valley = false;             // rise < least_rise
    int iterations = 0;                   // of Brent's method
    std::vector<Evaluation> evaluations;  // all of them, by increasing parameter

    // Only then x says something of the parameter.
    bool identifiable() const { return outcome == MinimumOutcome::converged && !flat_valley; }
};

// InputError unless low < high, both finite, with at least three samples. A function that throws is not caught.
Minimum minimise(const Misfit& function, double low, double high, const MinimiseOptions& options = {});

// One parameter fitted to several cases at once: the root mean square of their misfits is minimised.
struct FittedParameter {
    Minimum all;                  // of the root mean square over all cases
    std::vector<Minimum> cases;   // each case alone
    std::vector<double> without;  // all cases but one (leave one out)
    Interval interval;            // jackknife: all.x +- Student's t (n - 1) times sqrt((n - 1) / n sum (without - their mean)^2), cut to
                                  // [low, high]; NaN bounds for fewer than two cases
};
// One misfit a case, >= 0; each is asked once at a parameter. level: of the interval. InputError as minimise, and without any case.
FittedParameter fit_over_cases(const std::vector<Misfit>& misfits, double low, double high, const MinimiseOptions& options = {},
                               double level = 0.95);

}  // namespace analysis
