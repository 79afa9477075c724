// The panel of Cook's membrane: corners (0,0), (48,44), (48,60), (0,44) mm, 1 mm thick. Units: N and mm. Only the half
// above the middle plane z = 0 is modelled, where u_z = 0. The whole panel is thin and buckles sideways far below the load of the finite
// strain benchmark.
#pragma once

#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

namespace reference_fem {

pbs::TetMesh membrane(int n);  // n x n x 1 cells, 0.5 mm thick

// Clamped on the left, a uniform shear [N/mm^2] on the right; plane strain: u_z held on the outer face, else it is free.
BoundaryValueProblem membrane_problem(double shear, bool plane_strain, int element_order);

}  // namespace reference_fem
