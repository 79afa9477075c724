// Heavy headers (deal.II takes some 20 s a file) are seen, through whatever chain of includes, by few .cpp files of one place each, so
// that a change in the method recompiles in seconds.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations heavy_headers(const SourceTree& tree);

}  // namespace architecture
