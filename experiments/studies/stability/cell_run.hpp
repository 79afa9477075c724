// Runs a cell twice, disturbed and undisturbed, and determines its outcome.
//   const CellResult result = run_cell(cell);
#pragma once

#include "analysis/metrics/stability_outcome.hpp"
#include "experiments/studies/stability/stability_cell.hpp"

#include <optional>

namespace experiments {

struct CellResult {
    analysis::StabilityResult stability;
    std::vector<analysis::StabilityStep> steps;
    bool has_undisturbed = false;  // the same body comes to rest when it begins in the last pose
    int steps_not_reached = 0;
    // From a broken initial state: the method's iterations up to and including the first step that was reached. For Newton's method this is
    // the number until the residual was within tolerance, including a first solve that failed. PBS and XPBD always do all their iterations.
    std::optional<int> iterations_until_reached;
    double cpu_s = 0.0;
};
CellResult run_cell(const StabilityCell& cell);
std::string endings_text();  // when a run ends early, as Markdown

}  // namespace experiments
