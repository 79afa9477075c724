// The lowest mode of free vibration: K phi = omega^2 M phi, phi = 0 where prescribed. By subspace iteration (K.-J. Bathe, Finite Element
// Procedures, 1996, section 11.6), which separates modes of nearly equal frequency, such as those of a bar of square section.
#pragma once

#include "reference_fem/dynamics/consistent_mass.hpp"
#include "reference_fem/linear_solver.hpp"

#include <vector>

namespace reference_fem {

// The frequency in Hz is omega / (2 pi).
struct Mode {
    double omega_rad_s = 0.0;  // not a number where the stiffness is singular: a body that may move rigidly
    Eigen::VectorXd shape;     // #dofs, the largest component 1 [m]
};

// stiffness [N/m], #dofs x #dofs, both triangles, nothing eliminated; prescribed: #dofs. From a fixed random block of 8 vectors, until the
// shape changes by less than 1e-13 of itself or 100 iterations are done. No degree of freedom free: not a number.
Mode first_mode(const SparseMatrix& stiffness, const ConsistentMass& mass, const std::vector<bool>& prescribed,
                LinearSolver solver = LinearSolver::cholmod);

}  // namespace reference_fem
