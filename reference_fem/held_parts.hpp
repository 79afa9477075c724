// A part of the mesh that nothing holds can move rigidly for free, and its stiffness matrix is singular.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace reference_fem {

// Each connected part of the mesh (over shared vertices) must contain three held points that are not on one line, else pbs::InputError
// naming a tet of the part. `points` [m], #P x 3, lie in `tets`, #P; -1: left out.
void require_held(const pbs::TetMesh& mesh, const pbs::Positions& points, const std::vector<int>& tets);

}  // namespace reference_fem
