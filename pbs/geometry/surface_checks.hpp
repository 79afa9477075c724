// The conditions on a surface; each violation is an InputError that names the file, the place, its value and the rule.
#pragma once

#include "pbs/geometry/guarded_reading.hpp"

namespace pbs {

// Checks the surface as the file has it: at least one triangle and one point, finite coordinates within 1e9 m, indices in range.
void check_raw_surface(const std::string& path, const IndexedPoints& mesh);

}  // namespace pbs
