// Springs between many points of the flesh and fixed targets as a few springs to ground, exact but for rounding.
//   const EquivalentSprings few = equivalent_springs(problem);
// A tet has the shape functions N. The springs of its points X_s have the energy sum_s k_s / 2 |X_s + u(X_s) - t_s|^2, which is, but for a
// constant and for each component of the nodes' displacements u, u^T Q u / 2 - f^T u with Q = sum_s k_s N(X_s) N(X_s)^T and
// f = sum_s k_s N(X_s) (t_s - X_s). Q = sum_m lambda_m v_m v_m^T by its eigenvectors, so one spring for each m, whose end moves by
// sqrt(lambda_m / k) v_m . u, has the same energy with the one stiffness k. f is a dead load.
//
// Nothing of the reference's own point location, shape functions or springs is used, which are what the comparison is to test.
#pragma once

#include "reference_fem/verification/calculix/nodal_problem.hpp"

namespace reference_fem {

struct EquivalentSpring {
    int tet = -1;
    Eigen::VectorXd coefficients;  // of the displacements of the tet's nodes, in their order; their sum of squares is at most 1
};
struct EquivalentSprings {
    double stiffness_n_m = 0.0;  // k, of each spring in each of the three directions: the largest eigenvalue
    std::vector<EquivalentSpring> springs;
    pbs::Positions forces_n;  // f [N], #N x 3
};

// Points outside every tet are left out, as the reference leaves them out. A point on a face is given to one of its tets. Eigenvalues below
// the rounding of the largest one are left out.
EquivalentSprings equivalent_springs(const NodalProblem& problem);

// N at a point of a straight tet from its four barycentric coordinates: 4 values or, at second order, 10.
Eigen::VectorXd tet_shape_functions(const Eigen::Vector4d& barycentric, int nodes_per_tet);

}  // namespace reference_fem
