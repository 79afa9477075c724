// The checks of mesh_surface on its input and on its own result: perturbing and exuding can undo what the refinement guaranteed.
#pragma once

#include "pbs/geometry/meshing.hpp"

#include <string>

namespace pbs {

// InputError unless enough vertices are requested, there are at least four triangles, all points are finite, all indices are in range,
// the surface is at least 1e-9 m large, and one that must be closed encloses a volume.
void check_surface(const SurfaceMesh& surface, const SurfaceMeshing& options);

// The signed volume inside the triangles [m^3], as if closed by a fan from the points' mean.
double enclosed_volume(const SurfaceMesh& surface);

// The first thing wrong with the mesh; empty when it is boundary-manifold, in one piece, of the wanted Euler number and dihedral
// angle, free of self-intersections, and all points lie inside.
inline constexpr const char* boundary_not_manifold = "the boundary is not manifold";
std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options);

}  // namespace pbs
