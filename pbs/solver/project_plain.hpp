// Order `plain`: one constraint after the other in file order, as the paper reads. The reference for every faster order.
#pragma once

#include "pbs/solver/constraint_set.hpp"

namespace pbs {

template <typename Scalar>
void project_bind_constraints(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& bind_points,
                              std::vector<Particle<Scalar>>& particles);

template <typename Scalar>
void project_stretch_constraints(const ConstraintSet<Scalar>& constraints, std::vector<Particle<Scalar>>& particles);

template <typename Scalar>
void project_volume_constraints(const ConstraintSet<Scalar>& constraints, VolumeForm form, std::vector<Particle<Scalar>>& particles);

}  // namespace pbs
