// Smooth weights of the bones in the flesh: each bone's weight is harmonic, 1 where that bone grips the flesh and 0 where another does.
// They predict where the flesh moves with the bones, for example as an initial guess of a solver.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// gripping_bone: #V, -1 where no bone grips. Linear elements. A connected part that nothing grips belongs to the first bone.
Weights harmonic_weights(const TetMesh& mesh, const std::vector<int>& gripping_bone, int bones);

}  // namespace pbs
