// Any linear elastic problem with known data on the boundary, through the same assembly, elimination and solver as the
// reference: patch tests, manufactured solutions, closed forms and published benchmarks verify it in this form, without
// a skeleton.
//   BoundaryValueProblem problem{.body_force = f, .displacement = u};
//   BoundaryValueSolution solution = solve(mesh, material, problem);
//   solution.errors(u, grad_u).l2;
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/newton/newton.hpp"
#include "reference_fem/options.hpp"

#include <vector>

namespace reference_fem {

// Valid as in lame_parameters: pbs::InputError where it is out of bounds.
struct ElasticMaterial {
    double young_pa = 1.0;  // Young's modulus E > 0; with the 1 of a benchmark in print, stresses are in units of E
    double poisson = 0.3;   // Poisson's ratio, -1 < nu < 0.5
};

// The components of a node's displacement that are held: all or none, or single ones (rollers, planes of symmetry).
struct Held {
    // implicit: a predicate may return a bool
    Held(bool all) : x(all), y(all), z(all) {}
    Held(bool hold_x, bool hold_y, bool hold_z) : x(hold_x), y(hold_y), z(hold_z) {}  // along the axes of the world

    bool x, y, z;  // true: that component is prescribed
};

// Data of a problem; inside the body nothing can be held.
struct BoundaryValueProblem {
    VectorField body_force = {};                          // [N/m^3]; empty: none
    VectorField displacement = {};                        // [m], where it is held; empty: zero
    std::function<Held(const pbs::Vec3&)> held = {};      // of the boundary nodes; empty: all are
    int element_order = 2;                                // 1, 2; taylor_hood: 2
    LinearSolver solver = LinearSolver::cholmod;          // with taylor_hood a direct one, and UMFPACK either way
    std::vector<Traction> tractions = {};                 // elsewhere the boundary is free
    Formulation formulation = Formulation::displacement;  // at finite strain not taylor_hood
};

// The solution and what it takes to evaluate it: the mesh may go.
struct BoundaryValueSolution {
    std::shared_ptr<const SimplexSpace> space;  // its node v is vertex v of the mesh
    Eigen::VectorXd displacement;               // [m], #dofs
    double residual = 0.0;   // |K u - f| / |f| over the free unknowns; infinite where K is singular, and the
                             // displacement is not a number
    Eigen::VectorXd load;    // of body force and tractions [N], #dofs
    std::vector<bool> held;  // #dofs
    Formulation formulation = Formulation::displacement;  // that it was solved in
    // lambda div u at the vertices, #V, with taylor_hood, else empty
    Eigen::VectorXd pressure_pa = {};

    // l2 [m^(5/2)], h1_seminorm [m^(3/2)]
    ErrorNorms errors(const VectorField& exact, const GradientField& exact_gradient) const;
    double largest_nodal_error(const VectorField& exact) const;  // [m]
    // with the solution's own material
    double strain_energy_j(const ElasticMaterial& material) const;
    // over the total force: the mean displacement along it
    double work_of_load_j() const { return load.dot(displacement); }

    // [m], of the nearest node
    pbs::Vec3 displacement_at(const pbs::Vec3& point) const;
    // [Pa], of the nearest vertex: the mean
    Eigen::Matrix3d stress_at(const pbs::Vec3& point, const ElasticMaterial& material) const;
    // over the tets that meet there
};

// pbs::InputError for a mesh that check_mesh refuses, an element_order or a material out of bounds, and taylor_hood
// unless the order is 2, nu > 0 and the solver a direct one. A body that may still move rigidly is not refused: with a
// direct solver `residual` shows it.
BoundaryValueSolution solve(const pbs::TetMesh& mesh, const ElasticMaterial& material,
                            const BoundaryValueProblem& problem);

// The conditions that a problem imposes on a space.
struct PrescribedData {
    std::vector<bool> held;  // #dofs
    Eigen::VectorXd values;  // [m], #dofs
};
// Boundary nodes only; without `displacement` the values are 0.
PrescribedData prescribed_data(const SimplexSpace& space, const BoundaryValueProblem& problem);
Eigen::VectorXd external_load(const SimplexSpace& space, const BoundaryValueProblem& problem);  // [N], #dofs
int nearest_node(const SimplexSpace& space, const pbs::Vec3& point);  // by rest position [m]; mid-edge nodes count

// A boundary value problem with any of the laws, by Newton along a load path: prescribed displacements and dead loads
// grow together.
//   FiniteStrainSolution solution =
//       solve_at_finite_strain(mesh, material, Model::isochoric_neo_hookean, problem, {.first_step = 0.2});
//   if (solution.path.converged()) solution.displacement_at(point);
// Not reaching the end is an outcome: path says how far it went.
struct FiniteStrainSolution {
    std::shared_ptr<const SimplexSpace> space;  // its node v is vertex v of the mesh
    Eigen::VectorXd displacement;               // [m], #dofs, of the last converged step
    LoadPathSummary path;                       // every attempt, with Newton's record

    pbs::Vec3 displacement_at(const pbs::Vec3& point) const;  // [m], of the nearest node
};

// pbs::InputError for a mesh, an element_order or a material that solve() refuses, for taylor_hood, and for
// mean_dilatation with isochoric_neo_hookean. Newton by its default options, with problem.solver.
FiniteStrainSolution solve_at_finite_strain(const pbs::TetMesh& mesh, const ElasticMaterial& material, Model model,
                                            const BoundaryValueProblem& problem, const LoadPathOptions& path);

}  // namespace reference_fem
