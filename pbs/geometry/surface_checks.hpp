// The conditions on a surface; each violation is an InputError that names the file, the place, its value and the rule.
#pragma once

#include "pbs/geometry/guarded_reading.hpp"
#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// Checks the surface as the file has it: at least one triangle and one point, finite coordinates within 1e9 m, indices in range.
void check_raw_surface(const std::string& path, const IndexedPoints& mesh);

// Checks the surface after its points are joined: no edge is in three triangles or more. The points' numbers in the file are lost by then,
// so an edge is reported by the coordinates of its ends.
void check_surface_edges(const std::string& path, const SurfaceMesh& surface);

}  // namespace pbs
