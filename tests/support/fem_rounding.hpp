// Tolerances of tests of the reference. Rounding may change a solution by this much:
// reference_fem/verification/problems.hpp derives |e| <= c cond(K) |u|, where e is the error of the unknowns u, c =
// sqrt(n) eps and cond(K) is the condition number of the matrix itself. The bounds below follow from the residual r = K
// e, for which |r| <= c |K| |u|, with V the smallest volume of a tet:
//   energy norm      |e|_K^2 = e^T K e = r^T K^-1 r <= |r|^2 / min|eigenvalue of K|;
//   energy           |E(u + e) - E(u)| <= |u|_K |e|_K + |e|_K^2 / 2, with |u|_K = sqrt(2 E);
//   total force      of the residual along one axis: |t . r| <= sqrt(nodes) |r|, t a unit translation of all nodes;
//   stress at a vertex. On a tet of P1 or P2, strains are affine, and an affine f has max f^2 <= (20 / V) integral of
//                    f^2 (the least eigenvalue of a tet's P1 mass matrix is V / 20). Since e^T K e is the integral of 2
//                    mu |eps|^2 + lambda (div e)^2,
//                    |stress of e| <= sqrt(20 / V) (sqrt(2 mu) + sqrt(3 lambda)) |e|_K.
// With taylor_hood the unknowns include pressures, in units that make all entries of K of one size, and K is
// indefinite; the same holds for the norm of its two definite blocks, since e^T diag(1, -1) K e = e^T diag(1, -1) r.
//
// What the reference integrates over its tets goes through so many roundings (rounding_error.hpp):
//   Jacobian J of a tet: an entry of its inverse by cofactors goes through a dozen roundings, which cond(J) magnifies;
//   its determinant goes through fewer.
//   Shape function: its value or gradient on the unit tet goes through eight roundings, of the quadrature point and of
//   the polynomial.
//   Entry of a vector or matrix: there are nine roundings of products, and the sums over quadrature points and over
//   tets about a node.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/rounding_error.hpp"

#include <algorithm>
#include <cmath>

namespace test_support {

// A field at all nodes, in its own unit, #dofs.
inline Eigen::VectorXd at_nodes(const reference_fem::SimplexSpace& space, const reference_fem::VectorField& field)
{
    Eigen::VectorXd values(space.dofs());
    for (int node = 0; node < space.nodes(); ++node)
        values.segment<3>(3 * node) = field(space.node_positions().row(node));
    return values;
}

// Relative to the inverse and to the determinant on the worst tet: 12 cond(J) in the Frobenius norm.
inline double jacobian_roundings(const reference_fem::SimplexSpace& space)
{
    return 12.0 * worst_magnification({space.node_positions(), space.tet_nodes().leftCols(4)}).condition;
}

// The number of roundings of an entry that integrates products of so many shape functions or gradients.
inline double entry_roundings(const reference_fem::SimplexSpace& space, int points_1d, int functions)
{
    Eigen::VectorXi tets_about = Eigen::VectorXi::Zero(space.nodes());
    for (const int node : space.tet_nodes().reshaped()) ++tets_about(node);
    const int points = element_tables(space, points_1d).points_per_tet;
    return (1 + functions) * jacobian_roundings(space) + 8 * functions + 9 + points + tets_about.maxCoeff();
}

// The magnitudes of the terms of an assembled matrix, entry by entry. A sum of positive semidefinite matrices has
// |A_ij| <= sqrt(A_ii A_jj) in each of them, and sum sqrt(A_ii A_jj) <= sqrt(sum A_ii sum A_jj).
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
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
        most = std::max<int>(most, matrix.col(column).nonZeros());
    return most;
}

// The terms of a displacement's gradient: the largest sum over the nodes of a tet of |u_a| |grad N_a| [1]. The sum is
// convex, so that it has its maximum at a corner.
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
                sum += displacement.segment<3>(3 * space.tet_nodes()(tet, a)).norm() *
                       tables.gradients(tet, corner).row(a).norm();
            largest = std::max(largest, sum);
        }
    return largest;
}

struct SolveRounding {
    reference_fem::Spectrum spectrum;  // [N/m]
    double size_m = 0.0;               // |u| over all unknowns

    double relative() const { return rounding_bound(spectrum); }
    // |e|, which also bounds the error of any part of the unknowns
    double error_m() const { return relative() * size_m; }
    double residual_n() const { return error_m() * spectrum.smallest; }              // |r|
    double energy_norm() const { return error_m() * std::sqrt(spectrum.smallest); }  // |e|_K [sqrt(J)]
    double energy_j(double of_solution = 0.0) const
    {
        return (std::sqrt(2.0 * of_solution) + energy_norm() / 2.0) * energy_norm();
    }
    double force_n(int nodes) const { return std::sqrt(3.0 * nodes) * residual_n(); }  // all three axes
    double stress_pa(const reference_fem::Lame& lame, const pbs::TetMesh& mesh) const
    {
        const double volume = pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff();
        return std::sqrt(20.0 / volume) * (std::sqrt(2.0 * lame.mu_pa) + std::sqrt(3.0 * lame.lambda_pa)) *
               energy_norm();
    }
};

// |u| over displacements [m] and pressures in their own unit.
inline double size_of(const reference_fem::LinearFlesh& flesh, const Eigen::VectorXd& displacement,
                      const Eigen::VectorXd& pressure_pa)
{
    const double pressures = pressure_pa.size() == 0 ? 0.0 : pressure_pa.norm() / flesh.pressure_unit_pa();
    return std::hypot(displacement.norm(), pressures);
}

inline SolveRounding rounding_of(const reference_fem::BoundaryValueSolution& solution,
                                 const reference_fem::ElasticMaterial& material)
{
    const reference_fem::LinearFlesh flesh(
        *solution.space, reference_fem::lame_parameters(material.young_pa, material.poisson), solution.formulation);
    return {spectrum(solution, material), size_of(flesh, solution.displacement, solution.pressure_pa)};
}

// |u' - u| / |u| over all nodes.
inline double relative_error(const reference_fem::BoundaryValueSolution& solution,
                             const reference_fem::VectorField& exact)
{
    const Eigen::VectorXd expected = at_nodes(*solution.space, exact);
    return (solution.displacement - expected).norm() / expected.norm();
}

// The spectrum of LinearElasticity(mesh, options, attachment).
inline reference_fem::Spectrum spectrum_of(const pbs::TetMesh& mesh, const reference_fem::LinearOptions& options,
                                           const reference_fem::Attachment& attachment)
{
    using namespace reference_fem;
    const HeldSpace held(mesh, options.element_order, options.density_kg_m3, attachment);
    const LinearFlesh flesh(held.space(), lame_parameters(options.young_pa, options.poisson), options.formulation,
                            attachment.prescribed_tets);
    SparseMatrix stiffness = flesh.stiffness();
    held.springs().add_to(stiffness);
    return spectrum(stiffness, flesh.prescribed(held.prescribed()));
}

// The same after a solve.
inline SolveRounding rounding_of(const reference_fem::LinearElasticity& solved, const pbs::TetMesh& mesh,
                                 const reference_fem::LinearOptions& options,
                                 const reference_fem::Attachment& attachment)
{
    using namespace reference_fem;
    const SimplexSpace space(mesh, options.element_order);
    const LinearFlesh flesh(space, lame_parameters(options.young_pa, options.poisson), options.formulation);
    return {spectrum_of(mesh, options, attachment), size_of(flesh, solved.displacement(), solved.pressure_pa())};
}

}  // namespace test_support
