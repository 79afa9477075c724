// A boundary value problem with any of the laws, by Newton along a load path: prescribed displacements and dead loads grow together.
//   FiniteStrainSolution solution = solve_at_finite_strain(mesh, material, Model::isochoric_neo_hookean, problem, {.first_step = 0.2});
//   if (solution.path.converged()) solution.displacement_at(point);
#pragma once

#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/model.hpp"
#include "reference_fem/newton/load_path.hpp"

namespace reference_fem {

// Not reaching the end is an outcome: path says how far it went.
struct FiniteStrainSolution {
    std::shared_ptr<const SimplexSpace> space;  // its node v is vertex v of the mesh
    Eigen::VectorXd displacement;               // [m], #dofs, of the last converged step
    LoadPathSummary path;                       // every attempt, with Newton's record

    pbs::Vec3 displacement_at(const pbs::Vec3& point) const;  // [m], of the nearest node
};

// pbs::InputError for a mesh, an element_order or a material that solve() refuses, for taylor_hood, and for mean_dilatation with
// isochoric_neo_hookean. Newton by its default options, with problem.solver.
FiniteStrainSolution solve_at_finite_strain(const pbs::TetMesh& mesh, const ElasticMaterial& material, Model model,
                                            const BoundaryValueProblem& problem, const LoadPathOptions& path);

}  // namespace reference_fem
