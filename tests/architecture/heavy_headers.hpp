// Few .cpp files, of one place per library, include heavy headers (deal.II takes some 20 s per file), through whatever chain of includes,
// so that a change in the method recompiles in seconds.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations heavy_headers(const SourceTree& tree);

}  // namespace architecture
