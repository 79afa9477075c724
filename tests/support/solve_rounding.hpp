// How much rounding may change a solution of the reference, for tolerances. reference_fem/verification/problems.hpp derives |e| <= c
// cond(K) |u|, where e is the error of the unknowns u, c = sqrt(n) eps and cond(K) is the condition number of the matrix itself. The bounds
// below follow from the residual r = K e, for which |r| <= c |K| |u|, with V the smallest volume of a tet:
//   energy norm      |e|_K^2 = e^T K e = r^T K^-1 r <= |r|^2 / min|eigenvalue of K|;
//   energy           |E(u + e) - E(u)| <= |u|_K |e|_K + |e|_K^2 / 2, with |u|_K = sqrt(2 E);
//   total force      of the residual along one axis: |t . r| <= sqrt(nodes) |r|, t a unit translation of all nodes;
//   stress at a vertex. On a tet of P1 or P2, strains are affine, and an affine f has max f^2 <= (20 / V) integral of f^2 (the least
//                    eigenvalue of a tet's P1 mass matrix is V / 20). Since e^T K e is the integral of 2 mu |eps|^2 + lambda (div e)^2,
//                    |stress of e| <= sqrt(20 / V) (sqrt(2 mu) + sqrt(3 lambda)) |e|_K.
// With taylor_hood the unknowns include pressures, in units that make all entries of K of one size, and K is indefinite; the same holds for
// the norm of its two definite blocks, since e^T diag(1, -1) K e = e^T diag(1, -1) r.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/linear_flesh.hpp"
#include "reference_fem/verification/problems.hpp"

#include <cmath>

namespace test_support {

struct SolveRounding {
    reference_fem::Spectrum spectrum;  // [N/m]
    double size_m = 0.0;               // |u| over all unknowns

    double relative() const { return rounding_bound(spectrum); }
    double error_m() const { return relative() * size_m; }               // |e|, which also bounds the error of any part of the unknowns
    double residual_n() const { return error_m() * spectrum.smallest; }  // |r|
    double energy_norm() const { return error_m() * std::sqrt(spectrum.smallest); }  // |e|_K [sqrt(J)]
    double energy_j(double of_solution = 0.0) const { return (std::sqrt(2.0 * of_solution) + energy_norm() / 2.0) * energy_norm(); }
    double force_n(int nodes) const { return std::sqrt(3.0 * nodes) * residual_n(); }  // all three axes
    double stress_pa(const reference_fem::Lame& lame, const pbs::TetMesh& mesh) const
    {
        const double volume = pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff();
        return std::sqrt(20.0 / volume) * (std::sqrt(2.0 * lame.mu_pa) + std::sqrt(3.0 * lame.lambda_pa)) * energy_norm();
    }
};

// |u| over displacements [m] and pressures in their own unit.
inline double size_of(const reference_fem::LinearFlesh& flesh, const Eigen::VectorXd& displacement, const Eigen::VectorXd& pressure_pa)
{
    const double pressures = pressure_pa.size() == 0 ? 0.0 : pressure_pa.norm() / flesh.pressure_unit_pa();
    return std::hypot(displacement.norm(), pressures);
}

inline SolveRounding rounding_of(const reference_fem::BoundaryValueSolution& solution, const reference_fem::ElasticMaterial& material)
{
    const reference_fem::LinearFlesh flesh(*solution.space, reference_fem::lame_parameters(material.young_pa, material.poisson),
                                           solution.formulation);
    return {spectrum(solution, material), size_of(flesh, solution.displacement, solution.pressure_pa)};
}

// |u' - u| / |u| over all nodes.
inline double relative_error(const reference_fem::BoundaryValueSolution& solution, const reference_fem::VectorField& exact)
{
    Eigen::VectorXd at_nodes(solution.space->dofs());
    for (int node = 0; node < solution.space->nodes(); ++node)
        at_nodes.segment<3>(3 * node) = exact(solution.space->node_positions().row(node));
    return (solution.displacement - at_nodes).norm() / at_nodes.norm();
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
                                 const reference_fem::LinearOptions& options, const reference_fem::Attachment& attachment)
{
    using namespace reference_fem;
    const SimplexSpace space(mesh, options.element_order);
    const LinearFlesh flesh(space, lame_parameters(options.young_pa, options.poisson), options.formulation);
    return {spectrum_of(mesh, options, attachment), size_of(flesh, solved.displacement(), solved.pressure_pa())};
}

}  // namespace test_support
