// The linear law on a space in one of the formulations: its matrix and its energy.
//   const LinearFlesh flesh(space, lame, Formulation::taylor_hood);
//   const SparseMatrix stiffness = flesh.stiffness();
// Taylor-Hood (C. Taylor, P. Hood, Computers & Fluids 1, 1973): P2 displacements u and a continuous P1 pressure p =
// lambda div u, from
//   integral of 2 mu eps(u) : eps(v) + p div v = load(v)  for all v,
//   integral of q div u - p q / lambda = 0                for all q:
//   [ K_mu    B^T       ] [u]   [f]
//   [ B      -M / lambda ] [p] = [0].
// Stable in the sense of Babuska and Brezzi, so nothing locks as nu goes to 1/2 (D. Boffi, F. Brezzi, M. Fortin, Mixed
// finite element methods and applications, Springer 2013, section 8.8). The matrix is symmetric quasi-definite: by R.
// Vanderbei, SIAM J. Optim. 5, 1995, it has an LDL^T in every order without pivoting. CHOLMOD's, however, has no
// supernodes: 18 s where UMFPACK with METIS ordering takes 1.5 (51,073 unknowns, nu 0.3 to 0.49999), with the same
// residual. It is therefore solved that way, whichever direct solver is requested.
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/options.hpp"

#include <vector>

namespace reference_fem {

// K_ij = integral of lambda div(phi_i) div(phi_j) + 2 mu eps(phi_i) : eps(phi_j) [N/m], #dofs x #dofs; exact on
// straight tets.
SparseMatrix stiffness_matrix(const SimplexSpace& space, const Lame& material);

// The whole body has one material.
class LinearFlesh {
public:
    // held_tets: tets with prescribed positions. They share no pressure with the flesh around them.
    // pbs::InputError for taylor_hood unless element_order is 2 and lambda > 0. The space outlives this object.
    LinearFlesh(const SimplexSpace& space, const Lame& lame, Formulation formulation,
                const std::vector<int>& held_tets = {});

    // Unknowns: the displacements of the nodes [m], #dofs; with taylor_hood one pressure per vertex after them, in
    // units of pressure_unit_pa(), which make all entries [N/m] of one size.
    int unknowns() const;
    int pressures() const { return static_cast<int>(has_pressure_.size()); }  // #V, or 0
    // mu / (mean tet volume)^(1/3) in SI units; 0 without taylor_hood
    double pressure_unit_pa() const { return pressure_unit_pa_; }
    SparseMatrix stiffness() const;  // unknowns x unknowns, both triangles
    // the one that can solve this system: always UMFPACK with taylor_hood
    LinearSolver solver(LinearSolver asked_for) const;

    // Those that are known beforehand: prescribed degrees of freedom, #dofs, and pressures at vertices that only held
    // tets have.
    std::vector<bool> prescribed(const std::vector<bool>& of_dofs) const;

    // loads or prescribed values, with zeros for the pressures
    Eigen::VectorXd on_unknowns(const Eigen::VectorXd& of_dofs) const;
    Eigen::VectorXd displacement(const Eigen::VectorXd& unknowns) const;  // [m], #dofs
    Eigen::VectorXd pressure_pa(const Eigen::VectorXd& unknowns) const;   // #V, positive in tension, or empty

    // Energy of a solution [J]; the pressure is read with taylor_hood only.
    double strain_energy_j(const Eigen::VectorXd& displacement, const Eigen::VectorXd& pressure_pa) const;

    // lambda div u as the formulation has it, each tet that meets at the vertex with its own: their mean [Pa].
    double pressure_at_vertex_pa(const Eigen::VectorXd& displacement, const Eigen::VectorXd& pressure_pa,
                                 int vertex) const;

private:
    const SimplexSpace& space_;
    Lame lame_;
    Formulation formulation_;
    double pressure_unit_pa_ = 0.0;
    std::vector<bool> held_tet_;      // #T, with taylor_hood
    std::vector<bool> has_pressure_;  // #V, with taylor_hood
};

}  // namespace reference_fem
