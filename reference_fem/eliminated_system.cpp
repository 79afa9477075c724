#include "reference_fem/eliminated_system.hpp"

#include <limits>

namespace reference_fem {
namespace {

constexpr int not_in_block = -1;

std::vector<int> places(const std::vector<int>& kept, Eigen::Index size)
{
    std::vector<int> place(size, not_in_block);
    for (std::size_t k = 0; k < kept.size(); ++k) place[kept[k]] = static_cast<int>(k);
    return place;
}

bool are_whole_nodes(const std::vector<int>& dofs)
{
    for (std::size_t k = 0; k < dofs.size(); ++k)
        if (dofs[k] % 3 != static_cast<int>(k % 3) || (k % 3 > 0 && dofs[k] != dofs[k - 1] + 1)) return false;
    return dofs.size() % 3 == 0;
}

}  // namespace

EliminatedSystem::Block EliminatedSystem::block(const SparseMatrix& matrix, const std::vector<int>& rows, const std::vector<int>& columns)
{
    const std::vector<int> row_place = places(rows, matrix.rows());
    Block kept{SparseMatrix(rows.size(), columns.size()), {}};
    for (std::size_t c = 0; c < columns.size(); ++c) {
        kept.matrix.startVec(c);
        for (auto k = matrix.outerIndexPtr()[columns[c]]; k < matrix.outerIndexPtr()[columns[c] + 1]; ++k) {
            const int row = row_place[matrix.innerIndexPtr()[k]];
            if (row == not_in_block) continue;
            kept.matrix.insertBack(row, c) = matrix.valuePtr()[k];
            kept.source.push_back(k);
        }
    }
    kept.matrix.finalize();
    return kept;
}

EliminatedSystem::EliminatedSystem(const SparseMatrix& stiffness, const std::vector<bool>& prescribed, LinearSolver solver,
                                   const Eigen::MatrixXd& near_null_space)
{
    for (std::size_t i = 0; i < prescribed.size(); ++i) (prescribed[i] ? prescribed_ : free_).push_back(static_cast<int>(i));
    free_free_ = block(stiffness, free_, free_);
    free_prescribed_ = block(stiffness, free_, prescribed_);
    NearNullSpace free_space{.block_size = are_whole_nodes(free_) ? 3 : 1};
    if (near_null_space.rows() == stiffness.rows()) free_space.modes = near_null_space(free_, Eigen::all);
    factor_ = prepare(free_free_.matrix, solver, free_space);
}

void EliminatedSystem::update(const SparseMatrix& stiffness)
{
    for (Block* kept : {&free_free_, &free_prescribed_})
        for (std::size_t k = 0; k < kept->source.size(); ++k) kept->matrix.valuePtr()[k] = stiffness.valuePtr()[kept->source[k]];
    factor_->refactor();
}

EliminatedSolution EliminatedSystem::solve(const Eigen::VectorXd& load, const Eigen::VectorXd& prescribed_values) const
{
    EliminatedSolution solution{prescribed_values, 0.0};
    const Eigen::VectorXd right_hand_side = load(free_) - free_prescribed_.matrix * prescribed_values(prescribed_);
    if (free_.empty()) return solution;
    if (!factor_->usable()) {
        solution.displacement.setConstant(std::numeric_limits<double>::quiet_NaN());
        solution.residual = std::numeric_limits<double>::infinity();
        return solution;
    }
    const Eigen::VectorXd free_values = factor_->solve(right_hand_side);
    solution.displacement(free_) = free_values;
    const double defect = (free_free_.matrix * free_values - right_hand_side).norm();
    solution.residual = defect == 0.0 ? 0.0 : defect / right_hand_side.norm();
    return solution;
}

}  // namespace reference_fem
