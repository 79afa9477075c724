// Meshing at a wanted number of vertices: the cell size is searched.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <functional>

namespace pbs {

// Calls mesh_at(cell size [m]) a few times, along the secant of log #V over log size, until the number of vertices is within 5 % of
// the wanted one; the nearest mesh otherwise. mesh_at may return an empty mesh where a size does not work out.
TetMesh mesh_at_vertex_count(int vertices, double first_size, const std::function<TetMesh(double size)>& mesh_at);

}  // namespace pbs
