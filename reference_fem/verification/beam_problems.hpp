// The two bars that more than one problem solves.
#pragma once

#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {

// Tip deflection under a shear of 1 N; P2 bounded by what the clamp may do (cantilever.cpp).
VerificationRow cantilever_row(const Effort& effort, double poisson, int element_order, Formulation formulation,
                               const Divisions& divisions);

// Torque of a cube of n^3 cells, without bounds (torsion.cpp).
VerificationRow torsion_row(const Effort& effort, double poisson, int element_order, Formulation formulation, int n);

}  // namespace reference_fem
