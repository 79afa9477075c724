// A sparse solver prepared for one matrix and kept for many right-hand sides.
//   auto solver = prepare(matrix, LinearSolver::cholmod);
//   if (solver->usable()) x = solver->solve(b);
//   solver->refactor();   // the matrix has other values in the same pattern: a symbolic analysis is kept
// CHOLMOD (supernodal Cholesky, ordered by AMD, or METIS where that fills in less) is the default; UMFPACK (unsymmetric LU) is the second
// opinion on the same matrix. Both are SuiteSparse's, called directly. Conjugate gradients with Trilinos ML are for what their factors do
// not fit in memory for.
#pragma once

#include "reference_fem/linear_solver.hpp"
#include "reference_fem/sparse_matrix.hpp"

#include <memory>
#include <string>

namespace reference_fem {

// Breakdown is never thrown: usable() reports it, or the solution is not finite.
class PreparedSolver {
public:
    virtual ~PreparedSolver() = default;

    virtual Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const = 0;  // only where usable(); not finite where it failed
    virtual void refactor() = 0;                  // after the matrix's values, not its pattern, have changed
    virtual std::string name() const = 0;         // library, version and ordering, for records
    virtual int iterations() const { return 0; }  // of the last solve; 0 of a direct solver

    bool usable() const { return usable_; }          // false: singular in double, or (CHOLMOD) not positive definite, or no hierarchy
    double analyse_s() const { return analyse_s_; }  // ordering and symbolic analysis
    double factor_s() const { return factor_s_; }    // the last numerical factorisation, or hierarchy
    double reciprocal_condition() const { return reciprocal_condition_; }  // the library's own rough estimate; 0: none

protected:
    bool usable_ = false;                                                   // as the last refactor() left it
    double analyse_s_ = 0.0, factor_s_ = 0.0, reciprocal_condition_ = 0.0;  // [s], [s], [1]
};

// `matrix` is symmetric, holds both triangles, is compressed, and outlives the solver. `near_null_space`, #rows x #modes: what an iterative
// solver's coarse levels must keep, see near_null_space.hpp; empty: constants. Where its rows are whole nodes, block_size is 3.
struct NearNullSpace {
    Eigen::MatrixXd modes = {};  // #rows x #modes
    int block_size = 1;          // 1 or 3
};
// Analyses and factors at once. Leaves the BLAS at one thread, for good.
std::unique_ptr<PreparedSolver> prepare(const SparseMatrix& matrix, LinearSolver solver, const NearNullSpace& near_null_space = {});

std::unique_ptr<PreparedSolver> prepare_cholmod(const SparseMatrix& matrix);  // reads the upper triangle
std::unique_ptr<PreparedSolver> prepare_umfpack(const SparseMatrix& matrix);  // by the symmetric strategy, ordered by METIS
std::unique_ptr<PreparedSolver> prepare_cg_ml(const SparseMatrix& matrix, const NearNullSpace& near_null_space);  // starts MPI

}  // namespace reference_fem
