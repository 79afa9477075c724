// A damped oscillation fitted to a series, y(t) = c + exp(-d t) (a cos(w t) + b sin(w t)), by GSL's nonlinear least squares from the best
// of a grid of starts: frequency and damping ratio with intervals, or the word that there is none.
//   const DampedOscillation swing = fit_damped_oscillation(series, 0.01);
//   if (swing.found()) use(swing.frequency_hz.estimate, swing.damping_ratio.estimate);
#pragma once

#include "analysis/bootstrap.hpp"

#include <vector>

namespace analysis {

// overdamped: it creeps back, w is nothing but a rate; too_short: fewer than 8 samples before it has died away; unclear: less than half of
// its variance is the model's; none: it does not move.
enum class OscillationOutcome { found, overdamped, too_short, unclear, none };
const char* name_of(OscillationOutcome outcome);  // as it is spelt in the enum

// Figures are to be used only where found().
struct DampedOscillation {
    OscillationOutcome outcome = OscillationOutcome::none;  // what the series shows
    // w / 2 pi, and d / sqrt(d^2 + w^2): 0 for ever, 1 does not swing. Intervals by Student's t from the fit's covariance; what the model
    // leaves of a body with many modes is no white noise, so they are narrow.
    Interval frequency_hz, damping_ratio;
    double amplitude = 0.0, offset = 0.0;  // sqrt(a^2 + b^2) at the start and c, in the series' unit
    double explained = 0.0;                // share of the variance
    int samples = 0;                       // fitted to: until what is left is 2 % of the largest excursion

    bool found() const { return outcome == OscillationOutcome::found; }  // with intervals for frequency and damping
};

// series: at equal steps of dt_s [s] from t = 0, in any unit; level: of the intervals. Nothing is thrown: an empty series, one at rest and
// one that is not finite give none.
DampedOscillation fit_damped_oscillation(const std::vector<double>& series, double dt_s, double level = 0.95);

}  // namespace analysis
