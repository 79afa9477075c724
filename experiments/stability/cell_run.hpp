// Runs a cell twice, disturbed and undisturbed, and says what became of it.
//   const CellResult result = run_cell(cell);
#pragma once

#include "analysis/stability_outcome.hpp"
#include "experiments/stability/stability_cell.hpp"

namespace experiments {

// A run ends early where it is not finite, where the body has been at rest for 50 still steps, or where two steps in a row were not
// reached (each of them would be tried again at length).
struct CellResult {
    analysis::StabilityResult stability;
    std::vector<analysis::StabilityStep> steps;
    bool has_undisturbed = false;  // the same body, set out on the last pose, comes to rest
    int steps_not_reached = 0;
    double cpu_s = 0.0;
};
CellResult run_cell(const StabilityCell& cell);

}  // namespace experiments
