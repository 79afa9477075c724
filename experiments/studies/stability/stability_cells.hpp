// The cells of the map of stability, by method. full: more values of each factor, and more steps.
#pragma once

#include "experiments/studies/stability/cell_sweep.hpp"
#include "experiments/studies/stability/stability_cell.hpp"

namespace experiments {

std::vector<StabilityCell> pbs_cells(bool jiggle, bool full);  // on the limb, in both precisions
std::vector<StabilityCell> pbs_character_cells(const std::string& body, bool full);
std::vector<StabilityCell> pbs_map_cells(bool full);  // time step x k_stretch, iterations x twist
std::vector<StabilityCell> negative_controls();       // Eq. 12-20 as printed; distances whose squares overflow
std::vector<StabilityCell> xpbd_cells(bool full);
std::vector<StabilityCell> fem_static_cells(bool full);   // linear, corotational, stable neo-Hookean; in equilibrium
std::vector<StabilityCell> fem_dynamic_cells(bool full);  // corotational, stable neo-Hookean; in time
std::vector<StabilityCell> other_cells(bool full);        // the other deformers, on the limb

// A deformer that is compared with PBS.
struct ComparedKind {
    const char* kind;
    bool minimises;                                // an energy, from an initial guess: broken_start.hpp
    const char* without_start;                     // why it has no broken start, otherwise
    std::vector<const Sweep*> beyond_limits = {};  // settings up to and beyond those for which it is known to converge
};
const std::vector<ComparedKind>& compared_kinds();

}  // namespace experiments
