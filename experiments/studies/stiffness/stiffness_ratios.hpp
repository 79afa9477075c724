// How a stiffness changes when one thing is doubled and nothing else: the values of claim C11, and exponents over a whole sweep.
//   measurement_table(stiffness_ratios(rows, Varied::iterations)).write("measurements.csv");
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/studies/stiffness/resting_body.hpp"

namespace experiments {

// time_step: halved. resolution: the number of vertices, whose meshes are never exactly twice each other.
enum class Varied { iterations, time_step, resolution };
template <>
struct OptionNames<Varied> {
    static constexpr std::array<std::pair<Varied, const char*>, 3> table{
        {{Varied::iterations, "iterations"}, {Varied::time_step, "time_step"}, {Varied::resolution, "resolution"}}};
};

struct VariedText {
    const char *factor, *doubled;  // "1 / time step", "half the time step"
    const char* quantity;          // in measurements.csv
    double first, last;            // settings next to the paper's, in the factor's unit
};
const VariedText& text_of(Varied varied);

// The ratio of stiffnesses for one doubling, (K2 / K1)^(log 2 / log(x2 / x1)), from the first to the last of the settings next to the
// paper's (12 to 48 iterations, 20 to 5 ms; all resolutions). low and high are the least and the largest ratio of every single doubling
// there, over file order, random orders and the second series of meshes. Runs that did not converge, or whose flesh rises against gravity,
// are left out. The claim is judged by a character's jiggling zone as the paper's solver runs it; a bar, or a zone whose surroundings are
// held, is "flesh held".
std::vector<analysis::Measurement> stiffness_ratios(const std::vector<StiffnessRow>& rows, Varied varied);

// K = c x^exponent over all settings, in file order, by least squares: a row of exponents.csv.
struct StiffnessExponent {
    Varied varied = Varied::iterations;
    analysis::CaseKey of;            // everything that is not varied
    double first = 0.0, last = 0.0;  // of what is varied; time steps in ms
    int points = 0, left_out = 0;    // left out: settings that did not converge, or hang upwards
    double exponent = 0.0, low = 0.0, high = 0.0;
};
const analysis::Columns<StiffnessExponent>& exponent_columns();
std::vector<StiffnessExponent> stiffness_exponents(const std::vector<StiffnessRow>& rows, Varied varied);

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::Varied> : experiments::OptionNames<experiments::Varied> {
};
