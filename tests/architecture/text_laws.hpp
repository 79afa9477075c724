// Texts that no file of the project may contain.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations absolute_paths(const SourceTree& tree);  // paths in a home or work folder
Violations unfinished_marks(const SourceTree& tree);
Violations stray_whitespace(const SourceTree& tree);  // tabs, and blanks at the end of a line

}  // namespace architecture
