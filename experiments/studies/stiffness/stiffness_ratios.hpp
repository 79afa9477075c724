// What a stiffness does when one thing is doubled and nothing else: the figures of claim C11, and exponents over a whole sweep.
//   measurement_table(stiffness_ratios(rows, Varied::iterations)).write("measurements.csv");
#pragma once

#include "analysis/case_record.hpp"
#include "analysis/line_fit.hpp"
#include "experiments/studies/stiffness/stiffness_row.hpp"

namespace experiments {

// time_step: halved. resolution: the number of vertices, whose meshes are never exactly twice each other.
enum class Varied { iterations, time_step, resolution };

// The ratio of stiffnesses for one doubling, (K2 / K1)^(log 2 / log(x2 / x1)), from the first to the last of the settings next to the
// paper's (12 to 48 iterations, 20 to 5 ms; all resolutions); low and high: the least and the most of every single doubling there, file
// order, random orders and the second ladder of meshes alike. What did not converge, or hangs upwards, is left out. The claim is judged by
// a character's jiggling zone as the paper's solver runs it; a bar, or a zone whose surroundings are held, is named "flesh held".
std::vector<analysis::Measurement> stiffness_ratios(const std::vector<StiffnessRow>& rows, Varied varied);

struct StiffnessExponent {
    std::string what;                // limb, zone, pbs k_stretch 0.2, 10 ms, 593 vertices
    double first = 0.0, last = 0.0;  // of what is varied
    int left_out = 0;                // settings that did not converge, or hang upwards
    analysis::LineFit fit;           // log stiffness over log x: slope with 95 % bounds
};
// K = c x^slope over all settings, file order, by least squares.
std::vector<StiffnessExponent> stiffness_exponents(const std::vector<StiffnessRow>& rows, Varied varied);

}  // namespace experiments
