// The weights of Eq. 2 as the code published by the paper's first author reads them (author_solver.hpp). Eq. 2 leaves n_joints open: at the
// head of a bone that code counts the bone and its parent, at the tail the bone and all of its children.
//   const Weights weights = author_weights(binding, skeleton);
// paper_weights (pbs/skinning/weights.hpp) differ where siblings start at the same head, and where a child starts elsewhere than at the
// tail of its parent.
#pragma once

#include "pbs/skinning/weights.hpp"

namespace pbs {

// `binding` must belong to this skeleton (unchecked). A vertex with 1/6 <= t <= 5/6, or near the head of a root, has its bone alone.
Weights author_weights(const BoneBinding& binding, const Skeleton& skeleton);

}  // namespace pbs
