// The step response of a body's flesh: the skeleton is moved by a jolt in one time step and then held still.
//   const JoltResponse response = jolt_response(character, spec, probe, {});
//   response.swing.frequency_hz.estimate, response.left_over_peak
// The quantity that swings is the mean displacement of the probe's vertices along the jolt, from where they lay before, moved with the
// skeleton.
#pragma once

#include "analysis/statistics/fits.hpp"
#include "experiments/deformers/registry.hpp"

#include <optional>
#include <vector>

namespace experiments {

struct Jolt {
    pbs::Vec3 direction = pbs::Vec3::UnitY();  // unit
    double length_m = 0.02;
    double time_step_s = 0.01;
    int still_steps = 2;  // before it
    int steps = 150;      // including that of the jolt
};

struct JoltResponse {
    std::vector<double> excursion_m;    // of the probe, one per step, beginning with that of the jolt
    std::vector<double> speed_rms_m_s;  // of all the body's vertices
    analysis::DampedOscillation swing;  // fitted to the excursion
    double peak_over_jolt = 0.0;        // largest excursion, either way; 1 where flesh stays behind at first
    double overshoot_over_jolt = 0.0;   // largest excursion beyond the place on the skeleton
    double left_over_peak = 0.0;        // largest excursion of the last tenth
    double speed_growth = 0.0;          // largest speed after the first tenth over that within it; above 1, energy has grown
    bool finished = true;               // every step
};

JoltResponse jolt_response(const pbs::Character& character, const DeformerSpec& spec, const std::vector<int>& probe, const Jolt& jolt);
JoltResponse jolt_response(const pbs::Character& character, Deformer& deformer, const std::vector<int>& probe, const Jolt& jolt);

// The same flesh as an elastic body in time. The Young's modulus of the finite elements is chosen so that they swing as fast as PBS does at
// one setting; damping and amplitude can then be compared.
struct JiggleReference {
    double young_pa = 0.0;  // the frequency is proportional to sqrt(E): chosen by that of the first modulus, then solved again
    double time_step_s = 0.0;
    JoltResponse response;  // with this modulus
};
inline constexpr int reference_steps_a_period = 24, reference_periods = 4;  // of the wanted frequency

// fem: dynamic, with any Young's modulus to begin with. Nothing where the body does not swing.
std::optional<JiggleReference> match_reference(const pbs::Character& character, DeformerSpec fem, const std::vector<int>& probe,
                                               const Jolt& jolt, double frequency_hz);

// Neo-Hookean, linear elements, generalised alpha.
DeformerSpec dynamic_reference(double young_pa);

}  // namespace experiments
