// The values that C09 is judged by, from the responses of one body at all settings.
//   for (const analysis::Measurement& measurement : jiggle_values("limb", measured)) ...
#pragma once

#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "experiments/studies/jiggle/jolt_response.hpp"

#include <string>
#include <vector>

namespace experiments {

struct MeasuredJiggle {
    JiggleSetting setting;
    JoltResponse response;
};

// The values of one body:
// - the share of the paper's own settings, all time steps included, at which the zone swings (DampedOscillation::found);
// - for those that swing: the frequency; the damping ratio, with that of other readings (unbound, lumped masses) as a quantity of its own;
//   the rank correlation of frequency and k_stretch, with its range when one setting is left out, and the ratio of frequencies at the ends;
//   the ratio of frequencies with twice the iterations and with the default;
// - for those that finish: the amplitude, which is the overshoot over the jolt;
// - the ratio of frequencies with half the time step and with the whole, for the first setting, with its range over all halvings. Without
//   gravity Algorithm 1 makes it 2 on any body: by lines 7, 8 and 16 a particle moves on by its last movement, x_n + (x_n - x_n-1), however
//   long a step is, so that the frequency is one per step.
std::vector<analysis::Measurement> jiggle_values(const std::string& body, const std::vector<MeasuredJiggle>& measured);

}  // namespace experiments
