// Some vertices' rows of a displacement, stacked, and back: the unknowns of a step near rest.
//   const StackedRows free(moves);   free.stacked(displacement);   // 3 #moving
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace experiments {

class StackedRows {
public:
    // Which of the vertices, #V; the others do not move.
    explicit StackedRows(const std::vector<bool>& moves) : vertices_(static_cast<Eigen::Index>(moves.size()))
    {
        for (std::size_t v = 0; v < moves.size(); ++v)
            if (moves[v]) moving_.push_back(static_cast<int>(v));
    }

    Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(moving_.size()); }

    // displacement [m], #V x 3
    Eigen::VectorXd stacked(const pbs::Positions& displacement) const
    {
        Eigen::VectorXd stack(size());
        for (std::size_t i = 0; i < moving_.size(); ++i)
            stack.segment<3>(3 * static_cast<Eigen::Index>(i)) = displacement.row(moving_[i]).transpose();
        return stack;
    }

    // [m], #V x 3; zero where nothing moves
    pbs::Positions at_vertices(const Eigen::VectorXd& stack) const
    {
        pbs::Positions displacement = pbs::Positions::Zero(vertices_, 3);
        for (std::size_t i = 0; i < moving_.size(); ++i)
            displacement.row(moving_[i]) = stack.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
        return displacement;
    }

private:
    Eigen::Index vertices_;
    std::vector<int> moving_;
};

}  // namespace experiments
