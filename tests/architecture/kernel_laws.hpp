// What is built for one machine's instructions keeps to itself: kernels see raw pointers, neither Eigen nor containers, whose inline code
// would else differ from that of the rest of the program; and nobody but them is built so, or sees registers.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations kernel_includes(const SourceTree& tree);    // headers that the sources of pbs_kernels may not see
Violations machine_flags(const SourceTree& tree);      // -march for a target that is no kernel
Violations registers_at_home(const SourceTree& tree);  // SIMD headers seen by what is no kernel

}  // namespace architecture
