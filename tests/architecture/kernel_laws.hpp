// Code that is built for one machine's instructions is isolated. Kernels use raw pointers and neither Eigen nor containers, whose inline
// code would otherwise differ from that of the rest of the program. No other code is built that way or includes SIMD headers.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations kernel_includes(const SourceTree& tree);    // headers that the sources of pbs_kernels must not include
Violations machine_flags(const SourceTree& tree);      // -march for a target that is not a kernel
Violations registers_at_home(const SourceTree& tree);  // SIMD headers included by code that is not a kernel

}  // namespace architecture
