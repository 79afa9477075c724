// Straight lines through data by least squares (GSL), and observed orders of convergence as slopes on log-log axes.
//   const Interval order = observed_order(mesh_size_m, error_l2_pct);   // 2.02 [1.97, 2.07]
#pragma once

#include "analysis/statistics/statistics.hpp"

#include <array>
#include <utility>
#include <vector>

namespace analysis {

// The slope of y = intercept + slope x. Its interval is by Student's t with n - 2 degrees of freedom, with NaN bounds
// for two points. InputError unless x and y have the same size, at least two, and the values of x differ.
Interval fit_line(const std::vector<double>& x, const std::vector<double>& y, double level = 0.95);

// The exponent p of error = c h^p. InputError unless all values are positive.
Interval observed_order(const std::vector<double>& h, const std::vector<double>& error, double level = 0.95);

// Where a cost that grows with size as a power reaches a limit.
//   // the size at which a frame takes 1 / 30 s
//   const PowerLawEnd end = power_law_end(vertices, ms_per_frame, 1e3 / 30.0);
struct PowerLawEnd {
    double size = 0.0;      // at which the cost is at the limit
    bool beyond = false;    // all measured costs are below the limit, or all are above it
    double exponent = 0.0;  // of the power law over all sizes
};

// On the straight line through log cost over log size between the two sizes around the limit, or beyond the last two.
// The sizes may have any order. InputError for fewer than two sizes, another number of costs, a size or cost that is
// not above 0, equal sizes, and equal costs at the two sizes that the line passes through.
PowerLawEnd power_law_end(const std::vector<double>& sizes, const std::vector<double>& costs, double limit);

// Fits a damped oscillation to a series, y(t) = c + exp(-d t) (a cos(w t) + b sin(w t)), by GSL's nonlinear least
// squares from the best point of a grid of initial guesses. The result is frequency and damping ratio with intervals,
// or the reason why there is none.
//   const DampedOscillation swing = fit_damped_oscillation(series, 0.01);
//   if (swing.found()) use(swing.frequency_hz.estimate, swing.damping_ratio.estimate);
// overdamped: the series creeps back, and w is only a rate. too_short: fewer than 8 samples before the motion has died
// away. unclear: the model explains less than half of the variance. none: nothing moves.
enum class OscillationOutcome { found, overdamped, too_short, unclear, none };
template <>
struct EnumNames<OscillationOutcome> {
    static constexpr std::array<std::pair<OscillationOutcome, const char*>, 5> table{
        {{OscillationOutcome::found, "found"},
         {OscillationOutcome::overdamped, "overdamped"},
         {OscillationOutcome::too_short, "too_short"},
         {OscillationOutcome::unclear, "unclear"},
         {OscillationOutcome::none, "none"}}};
};

// The values may be used only if found().
struct DampedOscillation {
    OscillationOutcome outcome = OscillationOutcome::none;  // the kind of motion in the series
    // w / 2 pi, and d / sqrt(d^2 + w^2): 0 swings for ever, 1 does not swing. The intervals use Student's t and the
    // covariance of the fit. The residual of a body with many modes is not white noise, so these intervals are too
    // narrow.
    Interval frequency_hz, damping_ratio;
    double explained = 0.0;  // share of the variance that the model explains
    int samples = 0;  // number of samples used by the fit: up to the time at which 2 % of the largest excursion remain

    bool found() const { return outcome == OscillationOutcome::found; }  // true if frequency and damping have intervals
};

// series: any unit, at equal steps of dt_s [s] from t = 0; level: confidence level of the intervals. Nothing is thrown:
// an empty series, a series at rest and one that is not finite give none.
DampedOscillation fit_damped_oscillation(const std::vector<double>& series, double dt_s, double level = 0.95);

}  // namespace analysis
