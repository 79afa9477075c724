// What mesh_surface tries: cell sizes until the number of vertices is right, and checks of its input and of each result.
#pragma once

#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <functional>
#include <string>

namespace pbs {

// Calls mesh_at(cell size [m]) a few times, along the secant of log #V over log size, until the number of vertices is within 5 % of
// the wanted one; the nearest mesh otherwise. mesh_at may return an empty mesh where a size does not work out.
TetMesh mesh_at_vertex_count(int vertices, double first_size, const std::function<TetMesh(double size)>& mesh_at);

// The checks of mesh_surface on its input and on its own result: perturbing and exuding can undo what the refinement guaranteed.

// InputError unless enough vertices are requested, there are at least four triangles, all points are finite, all indices are in range,
// the surface is at least 1e-9 m large, and one that must be closed encloses a volume.
void check_surface(const SurfaceMesh& surface, const SurfaceMeshing& options);

// The first thing wrong with the mesh; empty when it is boundary-manifold, in one piece, of the wanted Euler number and dihedral
// angle, free of self-intersections, and all points lie inside.
inline constexpr const char* boundary_not_manifold = "the boundary is not manifold";
std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options);

}  // namespace pbs
