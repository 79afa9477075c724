// The parts of a tet mesh that no face joins.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace pbs {

// The part of each tet, from 0 in the order of first tets, #T. Tets belong together if they share a face.
std::vector<int> parts_of(const Tets& tets);

// The tets for which `kept` is true, #T, and the vertices that they use, in their order.
TetMesh kept_tets(const TetMesh& mesh, const std::vector<bool>& kept);

}  // namespace pbs
