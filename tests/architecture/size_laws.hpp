// Sizes of files and functions: a file has 110 to 150 lines, 9 in 10 below 200, none over 500; a function has 10 to 15 lines, 9 in 10 at
// most 60, none over 120; a line of source has at most 140 columns.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations file_sizes(const SourceTree& tree);
Violations function_sizes(const SourceTree& tree);
Violations line_lengths(const SourceTree& tree);

}  // namespace architecture
