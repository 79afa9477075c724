// Runs a cell twice, disturbed and undisturbed, and says what became of it.
//   const CellResult result = run_cell(cell);
#pragma once

#include "analysis/stability_outcome.hpp"
#include "experiments/studies/stability/stability_cell.hpp"

#include <optional>

namespace experiments {

struct CellResult {
    analysis::StabilityResult stability;
    std::vector<analysis::StabilityStep> steps;
    bool has_undisturbed = false;  // the same body, set out on the last pose, comes to rest
    int steps_not_reached = 0;
    // From a broken start: of the method, in the steps up to and with the first that was reached. Of Newton's method, until its residual
    // was within tolerance, a first solve that failed counted in; PBS and XPBD take all of theirs in any case, which says nothing of them.
    std::optional<int> iterations_until_reached;
    double cpu_s = 0.0;
};
CellResult run_cell(const StabilityCell& cell);
std::string endings_text();  // when a run ends, Markdown

}  // namespace experiments
