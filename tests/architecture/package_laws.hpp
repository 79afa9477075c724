// cmake/packages.txt is the one list of what the project needs: well formed, and it covers what the CMake files look for.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations package_list_form(const SourceTree& tree);
Violations package_list_cover(const SourceTree& tree);

}  // namespace architecture
