// What a surface must satisfy; each breach is an InputError that names the file, the place, its value and the rule.
#pragma once

#include "pbs/geometry/guarded_reading.hpp"
#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// As the file has it: at least one triangle and one point, coordinates finite and within 1e9 m, indices in range.
void check_raw_surface(const std::string& path, const IndexedPoints& mesh);

// Points joined: no edge is in three triangles or more. Their numbers in the file are lost, so that an edge is told by its ends.
void check_surface_edges(const std::string& path, const SurfaceMesh& surface);

}  // namespace pbs
