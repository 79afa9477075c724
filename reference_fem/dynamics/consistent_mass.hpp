// The consistent mass of a space as an operator on displacements: the same scalar matrix for each component.
#pragma once

#include "reference_fem/nodal_matrix.hpp"

namespace reference_fem {

// Keeps its own matrix: the space may go.
class ConsistentMass {
public:
    ConsistentMass(const SimplexSpace& space, double density_kg_m3);  // of a homogeneous body; the sign of the density is not checked

    Eigen::VectorXd times(const Eigen::VectorXd& values) const;  // M x, #dofs
    void add_to(NodalMatrix& matrix, double factor) const;       // + factor M
    SparseMatrix matrix() const;                                 // M, #dofs x #dofs, [kg]

private:
    SparseMatrix of_nodes_;  // [kg], #nodes x #nodes
};

}  // namespace reference_fem
