// An elastic problem as an input deck of CalculiX 2.20 (G. Dhondt, CalculiX CrunchiX User's Manual; Debian's calculix-ccx).
//   write_calculix_deck(stream, problem, {});
// Elements C3D4 and C3D10, nodes and tets numbered from 1 in our order. A node that is held is held in all three components.
// Springs at points of the flesh are written as EquivalentSprings. Each has a node behind the problem's own ones
// as its end, which *EQUATION ties to the nodes of its tet, and three elements SPRING1, springs to ground.
#pragma once

#include "reference_fem/boundary_value_problem.hpp"

#include <iosfwd>
#include <string>

namespace reference_fem {

// Springs between points of the flesh and fixed targets: an energy sum_s k_s / 2 |X_s + u(X_s) - t_s|^2.
struct GroundSprings {
    pbs::Positions points;          // X_s at rest [m], #S x 3; one outside the tets is left out
    pbs::Positions targets;         // t_s [m], #S x 3
    Eigen::VectorXd stiffness_n_m;  // k_s [N/m], #S
};

// A static elastic problem as plain arrays at the nodes of a P1 or P2 space: the input of two programs.
struct NodalProblem {
    pbs::Positions nodes;  // rest [m], #N x 3
    TetNodes tets;         // #T x 4 or #T x 10: corners, then the middles of the edges 01 12 20 03 13 23
    ElasticMaterial material;
    double density_kg_m3 = 0.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero();
    std::vector<bool> held;   // #N
    pbs::Positions held_at;   // displacement [m], #N x 3, read at held nodes only
    pbs::Positions forces_n;  // [N], #N x 3
    GroundSprings springs = {};
};

struct AnsweredProblem {
    NodalProblem problem;
    pbs::Positions displacements;  // the reference's [m], #N x 3
    bool answered = true;          // false: the reference did not converge
};

// Degree of freedom 3 n + c and row n, column c have the same place in memory.
Eigen::Map<const Eigen::VectorXd> as_dofs(const pbs::Positions& at_nodes);
pbs::Positions at_nodes(const Eigen::VectorXd& dofs);

// Nodes and tets of the space; nothing held, no load.
NodalProblem nodal_problem(const SimplexSpace& space, const ElasticMaterial& material);

// The reference's linear answer without springs [m], #N x 3, on the space that the problem was made of.
pbs::Positions linear_displacements(const SimplexSpace& space, const NodalProblem& problem);

enum class CalculixAnalysis {
    linear,
    // NLGEOM: second Piola-Kirchhoff stress linear in the Green-Lagrange strain, the law of St Venant and Kirchhoff. Data grow linearly
    // with the fraction of the step.
    large_strain,
    none,  // nodes, tets and material without a step: the cost of reading
};

struct DeckOptions {
    CalculixAnalysis analysis = CalculixAnalysis::linear;
    double first_increment = 0.1;  // of the step, where large_strain
    double residual = 1e-9;        // at which Newton stops, over the mean force, where large_strain
    bool restart_file = true;      // CalculiX prints 7 digits; its restart file holds displacements in double
};

void write_calculix_deck(std::ostream& deck, const NodalProblem& problem, const DeckOptions& options);

// The nearest number that fits in 20 characters, with at least 14 digits: CalculiX refuses or, worse, cuts what is longer.
std::string calculix_number(double value);

// Springs between many points of the flesh and fixed targets as a few springs to ground, exact except for rounding.
//   const EquivalentSprings few = equivalent_springs(problem);
// A tet has the shape functions N. The springs of its points X_s have the energy sum_s k_s / 2 |X_s + u(X_s) - t_s|^2, which is, for each
// component of the nodes' displacements u and except for a constant, u^T Q u / 2 - f^T u with Q = sum_s k_s N(X_s) N(X_s)^T and
// f = sum_s k_s N(X_s) (t_s - X_s). Q = sum_m lambda_m v_m v_m^T by its eigenvectors, so one spring for each m, whose end moves by
// sqrt(lambda_m / k) v_m . u, has the same energy with the one stiffness k. f is a dead load.
//
// Nothing of the reference's own point location, shape functions or springs is used, which are what the comparison is to test.
struct EquivalentSpring {
    int tet = -1;
    Eigen::VectorXd coefficients;  // of the displacements of the tet's nodes, in their order; their sum of squares is at most 1
};
struct EquivalentSprings {
    double stiffness_n_m = 0.0;  // k, of each spring in each of the three directions: the largest eigenvalue
    std::vector<EquivalentSpring> springs;
    pbs::Positions forces_n;  // f [N], #N x 3
};

// Points outside every tet are left out, as the reference leaves them out. A point on a face is given to one of its tets. Eigenvalues below
// the rounding of the largest one are left out.
EquivalentSprings equivalent_springs(const NodalProblem& problem);

// N at a point of a straight tet from its four barycentric coordinates: 4 values or, at second order, 10.
Eigen::VectorXd tet_shape_functions(const Eigen::Vector4d& barycentric, int nodes_per_tet);

}  // namespace reference_fem
