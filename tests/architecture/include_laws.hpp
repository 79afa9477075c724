// Which folder may include which: geometry < skinning < character; geometry < constraints < solver. The reference (reference_fem) and the
// metrics (analysis) share only the mesh with the method; the verification of the reference writes records (analysis/records). The
// experiments depend on all of them and have layers of their own, in which no study includes another one. A drawn figure computes nothing.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations include_direction(const SourceTree& tree);
Violations layer_direction(const SourceTree& tree);  // the layers inside of experiments
// includes of this project in quotes, from the root, of files that exist; headers with #pragma once
Violations include_form(const SourceTree& tree);
Violations values_compute(const SourceTree& tree);
// outside experiments/deformers/, where code uses their traits and options instead
Violations deformers_tested_by_name(const SourceTree& tree);

}  // namespace architecture
