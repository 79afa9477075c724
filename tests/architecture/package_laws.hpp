// cmake/packages.txt is the one list of the project's requirements: it is well formed, and covers what the CMake files search for.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations package_list_form(const SourceTree& tree);
Violations package_list_cover(const SourceTree& tree);

}  // namespace architecture
