// Every source file is built, and the unit tests mirror the source folders.
#pragma once

#include "tests/architecture/source_tree.hpp"

namespace architecture {

Violations orphaned_sources(const SourceTree& tree);  // a .cpp that no CMake file names
Violations unit_mirror(const SourceTree& tree);       // tests/unit/A/... without a source folder A or pbs/A

}  // namespace architecture
