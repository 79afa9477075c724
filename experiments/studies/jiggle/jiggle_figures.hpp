// The figures of C09, from the responses of one body at all settings.
//   for (const analysis::Measurement& figure : jiggle_figures("limb", measured)) ...
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "experiments/studies/jiggle/jolt_response.hpp"

#include <string>
#include <vector>

namespace experiments {

struct MeasuredJiggle {
    JiggleSetting setting;
    JoltResponse response;
};

// Of the paper's own settings, time steps among them: the share of them at which the zone swings (DampedOscillation::found). Of those that
// swing: frequency; damping ratio, that of other readings (unbound, lumped masses) apart; how the frequency goes with k_stretch, as a rank
// correlation, with the least and the most that is left when one setting is left out, and as the ratio of its ends; the frequency at twice
// the iterations over that at the once. Of all that finish: amplitude, the overshoot over the jolt.
// The frequency at half the time step over that at the whole is one figure a body, of the first setting, with the least and the most over
// all halvings. Without gravity it is 2 by Algorithm 1, no finding of a body: by lines 7, 8 and 16 a particle goes on by what it went
// before, x_n + (x_n - x_n-1), however long a step is, so that the frequency is one per step.
std::vector<analysis::Measurement> jiggle_figures(const std::string& body, const std::vector<MeasuredJiggle>& measured);

}  // namespace experiments
