// How far particles are from satisfying their constraints; summed in double.
#pragma once

#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/step_summary.hpp"

namespace pbs {

// p: particle positions [m], #V; q: posed bind points [m], #V; sizes are not checked. A class that was left out has the residual zero.
template <typename Scalar>
Residuals residuals_of(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& p,
                       const std::vector<Vector3<Scalar>>& q);

// The largest of the three, what stop_residual is compared with: two are ratios, one is in metres. NaN where one is NaN.
double largest(const Residuals& residuals);

}  // namespace pbs
