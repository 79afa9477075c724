// Weights that vary smoothly because given ones have diffused through the flesh.
//   const Weights smooth = diffused_weights(mesh, paper_weights(binding, skeleton));
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// Steps of the default. Each goes half-way to the mean over the neighbours along the tets' edges, so that weights stay in [0, 1], add up to
// one and cannot alternate from vertex to vertex. After 8 steps a weight has spread by about two edges.
inline constexpr int diffusion_steps = 8;

// Weights below 1e-6 are left out, and the others of the vertex are scaled to a sum of one. A vertex without tets keeps its own.
Weights diffused_weights(const TetMesh& mesh, const Weights& weights, int steps = diffusion_steps);

}  // namespace pbs
