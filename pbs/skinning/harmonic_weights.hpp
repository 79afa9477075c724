// Smooth weights of the bones in the flesh: each bone's weight is harmonic between the vertices where it is known.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// Weights are 1 where their bone grips the flesh and 0 where another does. They predict where the flesh moves with the bones, for example
// as an initial guess of a solver. gripping_bone: #V, -1 where no bone grips. Linear elements. A connected part that nothing grips belongs
// to the first bone.
Weights harmonic_weights(const TetMesh& mesh, const std::vector<int>& gripping_bone, int bones);

// The same with given weights, of which a vertex may have several: known: #V, which rows of `weights` are given; weights: #V x #bones.
Weights harmonic_extension(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights);

}  // namespace pbs
