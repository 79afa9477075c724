// Roundings and magnitudes of what the reference integrates over its tets, for tolerances (rounding_error.hpp). The counts are:
//   Jacobian J of a tet: an entry of its inverse by cofactors goes through a dozen roundings, which cond(J) magnifies; its determinant
//   goes through fewer.
//   Shape function: its value or gradient on the unit tet goes through eight roundings, of the quadrature point and of the polynomial.
//   Entry of a vector or matrix: there are nine roundings of products, and the sums over quadrature points and over tets about a node.
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace test_support {

// Relative to the inverse and to the determinant on the worst tet: 12 cond(J) in the Frobenius norm.
inline double jacobian_roundings(const reference_fem::SimplexSpace& space)
{
    double worst = 0.0;
    for (const auto& tet : space.tet_nodes().rowwise()) {
        Eigen::Matrix3d edges;
        for (int c = 0; c < 3; ++c) edges.row(c) = space.node_positions().row(tet(c + 1)) - space.node_positions().row(tet(0));
        worst = std::max(worst, edges.norm() * edges.inverse().norm());
    }
    return 12.0 * worst;
}

// The number of roundings of an entry that integrates products of so many shape functions or gradients.
inline double entry_roundings(const reference_fem::SimplexSpace& space, int points_1d, int functions)
{
    Eigen::VectorXi tets_about = Eigen::VectorXi::Zero(space.nodes());
    for (const int node : space.tet_nodes().reshaped()) ++tets_about(node);
    const int points = element_tables(space, points_1d).points_per_tet;
    return (1 + functions) * jacobian_roundings(space) + 8 * functions + 9 + points + tets_about.maxCoeff();
}

// The magnitudes of the terms of an assembled matrix, entry by entry. A sum of positive semidefinite matrices has |A_ij| <= sqrt(A_ii A_jj)
// in each of them, and sum sqrt(A_ii A_jj) <= sqrt(sum A_ii sum A_jj).
inline reference_fem::SparseMatrix magnitudes(reference_fem::SparseMatrix matrix)
{
    const Eigen::VectorXd root = matrix.diagonal().cwiseAbs().cwiseSqrt();
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
        for (reference_fem::SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
            entry.valueRef() = root(entry.row()) * root(column);
    return matrix;
}

inline int most_entries(const reference_fem::SparseMatrix& matrix)  // of a column
{
    int most = 0;
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) most = std::max<int>(most, matrix.col(column).nonZeros());
    return most;
}

// The terms of a displacement's gradient: the largest sum over the nodes of a tet of |u_a| |grad N_a| [1]. The sum is convex, so that it
// has its maximum at a corner.
inline double largest_gradient_sum(const reference_fem::SimplexSpace& space, const Eigen::VectorXd& displacement)
{
    reference_fem::TetQuadrature corners{pbs::Positions::Zero(4, 3), Eigen::VectorXd::Constant(4, 1.0 / 24.0)};
    corners.points.bottomRows(3).setIdentity();
    const reference_fem::ElementTables tables = element_tables(space, corners);
    double largest = 0.0;
    for (Eigen::Index tet = 0; tet < space.tet_nodes().rows(); ++tet)
        for (int corner = 0; corner < 4; ++corner) {
            double sum = 0.0;
            for (int a = 0; a < tables.nodes_per_tet; ++a)
                sum += displacement.segment<3>(3 * space.tet_nodes()(tet, a)).norm() * tables.gradients(tet, corner).row(a).norm();
            largest = std::max(largest, sum);
        }
    return largest;
}

}  // namespace test_support
