// How many roundings what the reference integrates over its tets goes through, and the magnitudes of its terms, for tolerances
// (rounding_error.hpp).
//   The Jacobian J of a tet: a dozen for an entry of its inverse by cofactors, and fewer for its determinant, which cond(J) magnifies.
//   A shape function or its gradient on the unit tet: eight, of the quadrature point and the polynomial.
//   A sum over the quadrature points and over the tets about a node.
#pragma once

#include "reference_fem/element_tables.hpp"
#include "reference_fem/prepared_solver.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace test_support {

// Of the inverse and of the determinant, relative, on the worst tet: 12 cond(J) in the Frobenius norm.
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

// Of an entry of an assembled vector or matrix that integrates products of `functions` shape functions or gradients.
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

// The largest sum over the nodes of a tet of |u_a| |grad N_a|, the terms of a displacement's gradient. It is convex, so that it has its
// maximum at a corner.
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
