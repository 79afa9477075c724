// Is a mesh of a surface what was asked for? Perturbing and exuding can undo what the refinement guaranteed.
#pragma once

#include "pbs/geometry/meshing.hpp"

#include <string>

namespace pbs {

// The first thing wrong with the mesh; empty when it is boundary-manifold, in one piece, of the wanted Euler number and dihedral
// angle, free of self-intersections, and all points lie inside.
std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options);

}  // namespace pbs
