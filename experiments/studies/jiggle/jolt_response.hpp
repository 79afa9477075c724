// The step response of a body's flesh: the skeleton is moved by a jolt in one time step and then held still.
//   const JoltResponse response = jolt_response(character, spec, probe, {});
//   response.swing.frequency_hz.estimate, response.left_over_peak
// What swings is the probe: the mean displacement of its vertices along the jolt, from where the body lay before, moved with the skeleton.
#pragma once

#include "analysis/damped_oscillation.hpp"
#include "experiments/deformers/registry.hpp"

#include <vector>

namespace experiments {

struct Jolt {
    pbs::Vec3 direction = pbs::Vec3::UnitY();  // unit
    double length_m = 0.02;
    double time_step_s = 0.01;
    int still_steps = 2;  // before it
    int steps = 150;      // from the jolt's own on
};

struct JoltResponse {
    std::vector<double> excursion_m;    // of the probe, one a step from the jolt's own on
    std::vector<double> speed_rms_m_s;  // of all the body's vertices
    analysis::DampedOscillation swing;  // fitted to the excursion
    double peak_over_jolt = 0.0;        // largest excursion, either way; 1 where flesh stays behind at first
    double overshoot_over_jolt = 0.0;   // largest excursion beyond where the skeleton has it
    double left_over_peak = 0.0;        // largest excursion of the last tenth
    double speed_growth = 0.0;          // largest speed after the first tenth over that within it: above 1, energy has grown
    bool finished = true;               // every step
};

JoltResponse jolt_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe, const Jolt& jolt);
JoltResponse jolt_response(const pbs::Character& character, Deformer& deformer, const std::vector<int>& probe, const Jolt& jolt);

}  // namespace experiments
