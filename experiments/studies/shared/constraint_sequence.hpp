// The sequences in which a constraint set can list its edges and tets. Order `plain` projects in this sequence, and the batched orders
// derive theirs from it.
//   pbs::ConstraintSet<float> constraints = pbs::make_constraint_set<float>(...);   // in file order
//   in_random_sequence(constraints, 1);
#pragma once

#include "pbs/solver/constraint_set.hpp"

namespace experiments {

// Neighbours in the list come from eight distant parts of the old list in turn, so that no projection waits for the stores of the one
// before. Sorted edges share their first vertex with their neighbours.
template <typename Scalar>
void in_spread_sequence(pbs::ConstraintSet<Scalar>& constraints);

// A permutation that depends on the seed alone: the same on every machine and for float and double.
template <typename Scalar>
void in_random_sequence(pbs::ConstraintSet<Scalar>& constraints, unsigned seed);

}  // namespace experiments
