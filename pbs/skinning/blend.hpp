// The two blends the paper compares itself with: both move rest positions [m], #V x 3, into a pose. Sizes are not checked: `weights` has
// #V vertices or more, and the pose a transform for every bone that they name. `posed` is resized.
#pragma once

#include "pbs/skinning/weights.hpp"

namespace pbs {

// Linear blend skinning, Eq. 1: v' = sum_j w_j P_j R_j^-1 v [m]. A vertex without weights goes to the origin.
void linear_blend_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed);

// Dual quaternion linear blending (Kavan, Collins, Zara, O'Sullivan: Skinning with dual quaternions, I3D 2007). The
// transforms are rigid, and every vertex has at least one weight.
void dual_quaternion_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed);

}  // namespace pbs
