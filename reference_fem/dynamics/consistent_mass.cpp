#include "reference_fem/dynamics/consistent_mass.hpp"

#include "reference_fem/assembly.hpp"

namespace reference_fem {

ConsistentMass::ConsistentMass(const SimplexSpace& space, double density_kg_m3) : of_nodes_(mass_matrix(space, density_kg_m3))
{
}

Eigen::VectorXd ConsistentMass::times(const Eigen::VectorXd& values) const
{
    const Eigen::Map<const pbs::Positions> at_nodes(values.data(), of_nodes_.rows(), 3);
    Eigen::VectorXd product(values.size());
    // The matrix is symmetric: its columns are read as rows, which gathers instead of scattering.
    Eigen::Map<pbs::Positions>(product.data(), of_nodes_.rows(), 3).noalias() = of_nodes_.transpose() * at_nodes;
    return product;
}

void ConsistentMass::add_to(NodalMatrix& matrix, double factor) const
{
    matrix.add_isotropic(of_nodes_, factor);
}

SparseMatrix ConsistentMass::matrix() const
{
    SparseMatrix matrix(3 * of_nodes_.rows(), 3 * of_nodes_.cols());
    matrix.reserve(3 * of_nodes_.nonZeros());
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
        matrix.startVec(column);
        for (SparseMatrix::InnerIterator entry(of_nodes_, column / 3); entry; ++entry)
            matrix.insertBack(3 * entry.row() + column % 3, column) = entry.value();
    }
    matrix.finalize();
    return matrix;
}

}  // namespace reference_fem
