// The settings that C09's figures are measured at, and the figures.
//   for (const JiggleSetting& setting : jiggle_settings()) responses.push_back(...);
//   const auto figures = jiggle_figures("limb", measured);
#pragma once

#include "analysis/measurement.hpp"
#include "experiments/jiggle/jolt_response.hpp"

#include <string>
#include <vector>

namespace experiments {

struct JiggleSetting {
    double k_stretch = 0.1;  // in the zone; 1 elsewhere
    double time_step_s = 0.01;
    int iterations = 24;
    double k_bind = 1.0;  // in the zone; 1 elsewhere
    pbs::Masses masses = pbs::Masses::unit;
    bool operator==(const JiggleSetting&) const = default;
};

// One at a time from the first: k_stretch 0.05 to 1, steps of 2.5 to 40 ms, 6 to 96 iterations, both masses, the zone not bound.
std::vector<JiggleSetting> jiggle_settings();

DeformerSpec jiggling(DeformerSpec pbs, const JiggleSetting& setting);
std::string text_of(const JiggleSetting& setting);  // "k_stretch 0.1, 10 ms, 24 iterations, unit masses"; a k_bind below 1 behind it

struct MeasuredJiggle {
    JiggleSetting setting;
    JoltResponse response;
};

// Of the settings at which it swings: damping ratio, frequency; the rank correlation of frequency and k_stretch, with the least and the
// most that is left when one setting is left out; the ratios of frequencies at half the time step and at twice the iterations.
std::vector<analysis::Measurement> jiggle_figures(const std::string& body, const std::vector<MeasuredJiggle>& measured);

}  // namespace experiments
