// The same flesh as an elastic body in time: finite elements whose Young's modulus is chosen so that they swing as fast as PBS does at one
// setting; how far they then agree in damping and amplitude.
//   const JiggleReference reference = match_reference(character, fem, probe, jolt, pbs_frequency_hz);
#pragma once

#include "experiments/studies/jiggle/jolt_response.hpp"

#include <optional>

namespace experiments {

inline constexpr int reference_steps_a_period = 24, reference_periods = 4;  // of the frequency asked for

struct JiggleReference {
    double young_pa = 0.0;  // f goes with sqrt(E): from the first modulus' frequency, then solved again
    double time_step_s = 0.0;
    JoltResponse response;  // at it
};

// fem: dynamic, of any Young's modulus to begin with. Nothing where the first modulus does not swing.
std::optional<JiggleReference> match_reference(const pbs::Character& character, DeformerSpec fem, const std::vector<int>& probe,
                                               const Jolt& jolt, double frequency_hz);

// Stable neo-Hookean, linear elements, generalised alpha.
DeformerSpec dynamic_reference(double young_pa);

}  // namespace experiments
