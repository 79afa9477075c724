// A static elastic problem as plain arrays at the nodes of a P1 or P2 space: the input of two programs.
#pragma once

#include "reference_fem/boundary_value_problem.hpp"

namespace reference_fem {

// Springs between points of the flesh and fixed targets: an energy sum_s k_s / 2 |X_s + u(X_s) - t_s|^2.
struct GroundSprings {
    pbs::Positions points;          // X_s at rest [m], #S x 3; one outside the tets is left out
    pbs::Positions targets;         // t_s [m], #S x 3
    Eigen::VectorXd stiffness_n_m;  // k_s [N/m], #S
};

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

}  // namespace reference_fem
