// Who may include whom: geometry <- skinning <- character; geometry <- constraints <- solver; the judge (reference_fem) and the ruler
// (analysis) share only the mesh with the judged; experiments on top of all; a figure computes nothing.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations include_direction(const SourceTree& tree);
Violations include_form(const SourceTree& tree);  // ours from the root in quotes, and there; headers with #pragma once
Violations figures_compute(const SourceTree& tree);
Violations deformers_tested_by_name(const SourceTree& tree);  // outside experiments/deformers/: their traits and options are asked instead

}  // namespace architecture
