// K u = f with some degrees of freedom prescribed, by elimination: K_ff u_f = f_f - K_fp u_p. K_ff is factored once and K_fp is kept, so
// new loads and new prescribed values cost a right-hand side and a re-solve.
#pragma once

#include "reference_fem/prepared_solver.hpp"

#include <vector>

namespace reference_fem {

// Values of all degrees of freedom, with the prescribed ones at their values.
struct EliminatedSolution {
    Eigen::VectorXd displacement;  // [m], #dofs; not finite where the factorisation broke down
    double residual = 0.0;         // |K_ff u_f - right-hand side| / |right-hand side|; 0 where both are 0; infinite where it broke down
};

// Keeps K_ff and K_fp: the stiffness may go.
class EliminatedSystem {
public:
    // prescribed: #dofs. near_null_space, #dofs x #modes: for an iterative solver, see near_null_space.hpp.
    EliminatedSystem(const SparseMatrix& stiffness, const std::vector<bool>& prescribed, LinearSolver solver,
                     const Eigen::MatrixXd& near_null_space = {});

    // load [N] and prescribed_values [m], #dofs; the latter is read at prescribed degrees of freedom only.
    EliminatedSolution solve(const Eigen::VectorXd& load, const Eigen::VectorXd& prescribed_values) const;

    // Another stiffness of the same pattern: the symbolic analysis is kept.
    void update(const SparseMatrix& stiffness);

    bool usable() const { return free_.empty() || factor_->usable(); }  // false: solve() returns values that are not numbers
    const PreparedSolver& factor() const { return *factor_; }           // of K_ff

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
