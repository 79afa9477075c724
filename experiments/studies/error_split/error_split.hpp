// The error of PBS against the reference, split three ways. With x_n the shape after n iterations, x_inf the same constraints converged,
// x_h the reference on this mesh and x_0 its limit on ever finer ones,
//   x_n - x_0 = (x_n - x_inf) + (x_inf - x_h) + (x_h - x_0)
//               solver          model           discretisation
// exactly, vertex by vertex; in norm the parts bound the whole. The first two are measured; the third is the grid convergence index of the
// reference over element order and refinement. Beside them: what refinement does to PBS itself, the share of the attachment (the flesh held
// by the paper's bind constraint instead of by embedded bones) and of the bones' thickness (core_radius).
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/shared/posed_character.hpp"

namespace experiments {

struct ErrorSplitCase {
    Scene scene;                    // its character and motion
    std::vector<int> frames;        // of its motion
    DeformerSpec pbs, truth, twin;  // twin: the truth's law with linear elements
    std::vector<double> k_stretch;
    std::vector<int> iterations;
    int converged_iterations = 8000;  // x_inf; half of it says how far from converged
    std::vector<double> core_radii;   // beside the scene's own
    int refined_poses = 0;            // the first so many with the truth on the refined mesh too, the others with its twin alone
};

struct ErrorSplit {
    analysis::CsvTable parts;        // a row per pose, k_stretch and number of iterations
    analysis::CsvTable attachments;  // a row per pose and reference: how far it is from the twin, and how far converged PBS is from it
    std::string breakdown;           // what did not finish
};

ErrorSplit split_error(const ErrorSplitCase& of);

}  // namespace experiments
