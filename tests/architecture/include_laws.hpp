// Which folder may include which: geometry < skinning < character; geometry < constraints < solver. The reference (reference_fem) and the
// metrics (analysis) share only the mesh with the method. The experiments stand on top of all of them and have layers of their own, in
// which no study includes another one. A drawn figure computes nothing.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations include_direction(const SourceTree& tree);
Violations layer_direction(const SourceTree& tree);  // inside of experiments
Violations include_form(const SourceTree& tree);     // ours from the root in quotes, and there; headers with #pragma once
Violations figures_compute(const SourceTree& tree);
Violations deformers_tested_by_name(const SourceTree& tree);  // outside experiments/deformers/: their traits and options are asked instead

}  // namespace architecture
