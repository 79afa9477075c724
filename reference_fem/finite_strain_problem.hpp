// A boundary value problem with any of the laws, by Newton along a load path: prescribed displacements and dead loads grow together.
//   FiniteStrainSolution solution = solve_at_finite_strain(mesh, material, Model::isochoric_neo_hookean, problem, {.first_step = 0.2});
//   if (solution.path.converged()) solution.displacement_at(point);
#pragma once

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/model.hpp"
#include "reference_fem/newton/load_path.hpp"

namespace reference_fem {

struct FiniteStrainSolution {
    std::shared_ptr<const SimplexSpace> space;
    Eigen::VectorXd displacement;  // [m], #dofs, of the last converged step
    LoadPathSummary path;

    pbs::Vec3 displacement_at(const pbs::Vec3& point) const;  // [m], of the nearest node
};

FiniteStrainSolution solve_at_finite_strain(const pbs::TetMesh& mesh, const ElasticMaterial& material, Model model,
                                            const BoundaryValueProblem& problem, const LoadPathOptions& path);

}  // namespace reference_fem
