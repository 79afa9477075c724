// A sparse solver prepared for one matrix and kept for many right-hand sides.
//   auto solver = prepare(matrix, LinearSolver::cholmod);
//   if (solver->usable()) x = solver->solve(b);
//   solver->refactor();   // the matrix has other values in the same pattern: a symbolic analysis is kept
// CHOLMOD (supernodal Cholesky, ordered by AMD, or METIS where that fills in less) is the default; UMFPACK (unsymmetric
// LU) is the second opinion on the same matrix. Both are SuiteSparse's, called directly.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/options.hpp"

#include <memory>
#include <string>
#include <vector>

namespace reference_fem {

// Breakdown is never thrown: usable() reports it, or the solution is not finite.
class PreparedSolver {
public:
    virtual ~PreparedSolver() = default;

    // only where usable(); not finite where it failed
    virtual Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const = 0;
    virtual void refactor() = 0;           // after the matrix's values, not its pattern, have changed
    virtual std::string name() const = 0;  // library, version and ordering, for records

    // false: singular in double, or (CHOLMOD) not positive definite
    bool usable() const { return usable_; }
    double analyse_s() const { return analyse_s_; }  // ordering and symbolic analysis
    double factor_s() const { return factor_s_; }    // the last numerical factorisation
    double reciprocal_condition() const { return reciprocal_condition_; }  // the library's own rough estimate; 0: none

protected:
    bool usable_ = false;                                                   // as the last refactor() left it
    double analyse_s_ = 0.0, factor_s_ = 0.0, reciprocal_condition_ = 0.0;  // [s], [s], [1]
};

// Analyses and factors at once. The matrix is symmetric, holds both triangles, is compressed, and outlives the solver.
// Leaves the BLAS at one thread, for good. block_size: 3 where the rows are whole nodes, which CHOLMOD uses.
std::unique_ptr<PreparedSolver> prepare(const SparseMatrix& matrix, LinearSolver solver, int block_size = 1);

// Reads the upper triangle. The rows come in blocks of block_size with equal patterns, 3 if they are whole nodes,
// else 1. A block is ordered as one. pbs::InputError unless it divides the number of rows.
std::unique_ptr<PreparedSolver> prepare_cholmod(const SparseMatrix& matrix, int block_size);
// by the symmetric strategy, ordered by METIS
std::unique_ptr<PreparedSolver> prepare_umfpack(const SparseMatrix& matrix);

// Which BLAS the direct solvers really use: on Debian an alternative decides at run time, and the slow one costs a
// factor 3 to 7.
std::string resolved_blas();  // e.g. "OpenBLAS 0.3.21 ... (/usr/lib/x86_64-linux-gnu/openblas-pthread/libblas.so.3)"

// A sum's order depends on the number of threads; one thread makes every run the same to the bit. No effect on other
// BLAS than OpenBLAS.
void use_one_blas_thread();

// Values of all degrees of freedom, with the prescribed ones at their values.
struct EliminatedSolution {
    Eigen::VectorXd displacement;  // [m], #dofs; not finite where the factorisation broke down
    double residual =
        0.0;  // |K_ff u_f - right-hand side| / |right-hand side|; 0 where both are 0; infinite where it broke down
};

// K u = f with some degrees of freedom prescribed, by elimination: K_ff u_f = f_f - K_fp u_p. K_ff is factored once and
// K_fp is kept, so new loads and new prescribed values cost a right-hand side and a re-solve. The stiffness may go.
class EliminatedSystem {
public:
    // prescribed: #dofs.
    EliminatedSystem(const SparseMatrix& stiffness, const std::vector<bool>& prescribed, LinearSolver solver);

    // load [N] and prescribed_values [m], #dofs; the latter is read at prescribed degrees of freedom only.
    EliminatedSolution solve(const Eigen::VectorXd& load, const Eigen::VectorXd& prescribed_values) const;

    // Another stiffness of the same pattern: the symbolic analysis is kept.
    void update(const SparseMatrix& stiffness);

    // false: solve() returns values that are not numbers
    bool usable() const { return free_.empty() || factor_->usable(); }
    const PreparedSolver& factor() const { return *factor_; }  // of K_ff

private:
    struct Block {
        SparseMatrix matrix;
        std::vector<SparseMatrix::StorageIndex> source;  // of each value, in the whole matrix
    };
    static Block block(const SparseMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns);

    std::vector<int> free_, prescribed_;  // degrees of freedom, increasing
    Block free_free_, free_prescribed_;
    std::unique_ptr<PreparedSolver> factor_;
};

}  // namespace reference_fem
