// A bound on the effect of rounding on the solution of K u = f, computed from K. It is the tolerance of comparisons in which rounding is
// the only difference.
//   const Spectrum of_k = spectrum(stiffness, prescribed);
//   EXPECT_LT((ours - exact).norm(), rounding_bound(of_k) * exact.norm());
//
// A backward stable direct solver returns the exact solution of (K + E) u' = f with |E| <= c |K| (N. Higham, Accuracy and stability of
// numerical algorithms, 2nd ed., SIAM 2002: Theorem 10.4 for Cholesky, Theorem 9.4 for LU with a growth of 1), and forming f from
// prescribed values costs c |K| |u| again (Sec. 3.5). Hence, in the 2-norm over all unknowns (Theorem 7.2), with cond(K) = |K| |K^-1|,
//   |u' - u| <= c cond(K) |u|.
// c is the sum of up to 3 n + 1 roundings of one unit, n the number of unknowns. Roundings of random sign add up to the square root of
// their number (Sec. 2.8): sqrt(3 n + 1) times the unit roundoff eps / 2, which is below sqrt(n) eps.
#pragma once

#include "reference_fem/boundary_value_problem.hpp"

namespace reference_fem {

// The extreme eigenvalues in magnitude of a symmetric matrix, definite or not.
struct Spectrum {
    int unknowns = 0;                      // n
    double largest = 0.0, smallest = 0.0;  // magnitudes of eigenvalues, in the matrix's unit
    double condition() const { return largest / smallest; }
};

// The same for the block of the unknowns that are not prescribed. By Lanczos' method on it and on its inverse (by a direct solver), in at
// most 60 steps each: lower bounds of cond(K), which agree with dense eigenvalues to six digits on the meshes of the tests.
Spectrum spectrum(const SparseMatrix& symmetric, const std::vector<bool>& prescribed);
Spectrum spectrum(const BoundaryValueSolution& solution, const ElasticMaterial& material);  // in the solution's own formulation

double rounding_bound(const Spectrum& spectrum);  // sqrt(n) eps cond(K), relative
inline const std::string rounding_bound_text =
    "rounding of a direct solve: sqrt(n) eps cond(K), cond(K) by eigenvalues of this very matrix";

}  // namespace reference_fem
