// Any linear elastic problem with known data on the boundary, through the very assembly, elimination and solver of the judge: what patch
// tests, manufactured solutions and closed forms verify it with, beside the skeleton.
//   BoundaryValueProblem problem{.body_force = f, .displacement = u};
//   BoundaryValueSolution solution = solve(mesh, material, problem);
//   solution.errors(u, grad_u).l2;
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/direct_factor.hpp"

namespace reference_fem {

struct ElasticMaterial {
    double young_pa = 1.0;
    double poisson = 0.3;
};

struct BoundaryValueProblem {
    VectorField body_force;                           // [N/m^3]; empty: none
    VectorField displacement;                         // [m], at the held nodes
    std::function<bool(const pbs::Vec3&)> held = {};  // which boundary nodes are held; empty: all; the others are free of traction
    int element_order = 2;
    LinearSolver solver = LinearSolver::cholmod;
};

struct BoundaryValueSolution {
    std::shared_ptr<const SimplexSpace> space;
    Eigen::VectorXd displacement;  // [m], #dofs
    double residual = 0.0;

    ErrorNorms errors(const VectorField& exact, const GradientField& exact_gradient) const;
    double largest_nodal_error(const VectorField& exact) const;  // [m]
    double strain_energy_j(const ElasticMaterial& material) const;
};

BoundaryValueSolution solve(const pbs::TetMesh& mesh, const ElasticMaterial& material, const BoundaryValueProblem& problem);

}  // namespace reference_fem
