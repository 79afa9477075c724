// Cells in which one factor takes its values while everything else keeps its base value.
//   const Sweep time_step{"time_step", "s", {1e-4, 0.01, 1.0}, {0.001, 0.1}, [](StabilityCell& cell, double s) { cell.time_step_s = s; }};
//   append(cells, cells_of(time_step, base, full));
#pragma once

#include "experiments/studies/stability/stability_cell.hpp"

namespace experiments {

struct Sweep {
    using Set = void (*)(StabilityCell& cell, double value);

    std::string factor, unit;
    std::vector<double> values, more;  // more: in the full study only
    Set set;
    bool as_published = true;  // the paper's method with settings that it allows
};

std::vector<StabilityCell> cells_of(const Sweep& sweep, const StabilityCell& base, bool full);
std::vector<StabilityCell> cells_of_map(const Sweep& rows, const Sweep& columns, const StabilityCell& base, bool full);

// The factors that apply to every method.
extern const Sweep time_steps, twists, jumps, teleports, starts, slivers, needles;

void append(std::vector<StabilityCell>& cells, std::vector<StabilityCell> more);

}  // namespace experiments
