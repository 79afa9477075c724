// A sparse direct factorisation that is kept for many right-hand sides, by SuiteSparse called directly.
//   auto factor = factorise(matrix, LinearSolver::cholmod);
//   if (factor->usable()) x = factor->solve(b);
//   factor->refactor();   // the matrix has other values in the same pattern: the symbolic analysis is kept
// CHOLMOD (supernodal Cholesky, METIS ordering) is the default; UMFPACK (unsymmetric LU) is the second opinion on the same matrix.
#pragma once

#include "reference_fem/linear_solver.hpp"
#include "reference_fem/sparse_matrix.hpp"

#include <memory>
#include <string>

namespace reference_fem {

class DirectFactor {
public:
    virtual ~DirectFactor() = default;

    virtual Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const = 0;  // only where usable()
    virtual void refactor() = 0;  // after the matrix's values, not its pattern, have changed
    virtual std::string name() const = 0;

    bool usable() const { return usable_; }                                // false: singular in double, or (CHOLMOD) not positive definite
    double analyse_s() const { return analyse_s_; }                        // ordering and symbolic analysis
    double factor_s() const { return factor_s_; }                          // the last numerical factorisation
    double reciprocal_condition() const { return reciprocal_condition_; }  // the library's own rough estimate

protected:
    bool usable_ = false;
    double analyse_s_ = 0.0, factor_s_ = 0.0, reciprocal_condition_ = 0.0;
};

// `matrix` is symmetric, holds both triangles, is compressed, and outlives the factor.
std::unique_ptr<DirectFactor> factorise(const SparseMatrix& matrix, LinearSolver solver);

std::unique_ptr<DirectFactor> factorise_with_cholmod(const SparseMatrix& matrix);
std::unique_ptr<DirectFactor> factorise_with_umfpack(const SparseMatrix& matrix);

}  // namespace reference_fem
