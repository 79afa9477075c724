// What no file of the project may say.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations absolute_paths(const SourceTree& tree);  // of somebody's home or work folder
Violations unfinished_marks(const SourceTree& tree);
Violations stray_whitespace(const SourceTree& tree);  // tabs, blanks at a line's end

}  // namespace architecture
