// Order `plain`: one constraint after the other in file order, as the paper reads.
// p: particle positions [m], #V; q: posed bind points [m], #V.
#pragma once

#include "pbs/constraints/volume_printed.hpp"
#include "pbs/solver/constraint_set.hpp"

namespace pbs {

// Line 11 of Algorithm 1.
template <typename Scalar>
void project_bind_constraints(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& q,
                              std::vector<Vector3<Scalar>>& p);

// Line 12.
template <typename Scalar>
void project_stretch_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// Line 13, derived from Eq. 11.
template <typename Scalar>
void project_volume_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// The volumes of regions, one region after the other; after those of tets in line 13.
template <typename Scalar>
void project_region_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

// Eq. 12-20 as printed; masses are one there.
template <Printed form, typename Scalar>
void project_volume_constraints_printed(const ConstraintSet<Scalar>& constraints, std::vector<Vector3<Scalar>>& p);

}  // namespace pbs
