// Fits a damped oscillation to a series, y(t) = c + exp(-d t) (a cos(w t) + b sin(w t)), by GSL's nonlinear least squares from the best
// point of a grid of initial guesses. The result is frequency and damping ratio with intervals, or the reason why there is none.
//   const DampedOscillation swing = fit_damped_oscillation(series, 0.01);
//   if (swing.found()) use(swing.frequency_hz.estimate, swing.damping_ratio.estimate);
#pragma once

#include "analysis/bootstrap.hpp"

#include <vector>

namespace analysis {

// overdamped: the series creeps back, and w is only a rate. too_short: fewer than 8 samples before the motion has died away. unclear: the
// model explains less than half of the variance. none: nothing moves.
enum class OscillationOutcome { found, overdamped, too_short, unclear, none };
const char* name_of(OscillationOutcome outcome);  // as it is spelt in the enum

// The values may be used only if found().
struct DampedOscillation {
    OscillationOutcome outcome = OscillationOutcome::none;  // the kind of motion in the series
    // w / 2 pi, and d / sqrt(d^2 + w^2): 0 swings for ever, 1 does not swing. The intervals use Student's t and the covariance of the fit.
    // The residual of a body with many modes is not white noise, so these intervals are too narrow.
    Interval frequency_hz, damping_ratio;
    double amplitude = 0.0, offset = 0.0;  // sqrt(a^2 + b^2) at t = 0, and c, in the series' unit
    double explained = 0.0;                // share of the variance that the model explains
    int samples = 0;                       // number of samples used by the fit: up to the time at which 2 % of the largest excursion remain

    bool found() const { return outcome == OscillationOutcome::found; }  // true if frequency and damping have intervals
};

// series: any unit, at equal steps of dt_s [s] from t = 0; level: confidence level of the intervals. Nothing is thrown: an empty series, a
// series at rest and one that is not finite give none.
DampedOscillation fit_damped_oscillation(const std::vector<double>& series, double dt_s, double level = 0.95);

}  // namespace analysis
