// The conditions on a tet mesh before anything is computed on it; each violation is an InputError naming the file, the vertex or tet, its
// value and the rule. Vertices and tets are counted from 0, as in VTK.
#pragma once

#include "pbs/geometry/mesh_io.hpp"

namespace pbs {

// At least one tet, indices in range, coordinates finite and within 1e9 m, so that volumes are finite too.
void check_frame(const std::string& path, const TetMesh& mesh);

// check_frame, and: not smaller than 1e-9 m, no tet without volume, no two vertices in one place, no face in three tets,
// no overlap of neighbours, boundary manifold and, in a build with CGAL, free of self-intersections. Repaired by mesh_repair.hpp; the
// orientation is normalised by swapping the last two vertices.
MeshReading check_rest(const std::string& path, TetMesh mesh);

}  // namespace pbs
