// Any linear elastic problem with known data on the boundary, through the very assembly, elimination and solver of the judge: what patch
// tests, manufactured solutions, closed forms and published benchmarks verify it with, beside the skeleton.
//   BoundaryValueProblem problem{.body_force = f, .displacement = u};
//   BoundaryValueSolution solution = solve(mesh, material, problem);
//   solution.errors(u, grad_u).l2;
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/formulation.hpp"
#include "reference_fem/prepared_solver.hpp"

#include <vector>

namespace reference_fem {

struct ElasticMaterial {
    double young_pa = 1.0;
    double poisson = 0.3;
};

// Which components of a node's displacement are held: all or none, or single ones (rollers, planes of symmetry).
struct Held {
    Held(bool all) : x(all), y(all), z(all) {}
    Held(bool hold_x, bool hold_y, bool hold_z) : x(hold_x), y(hold_y), z(hold_z) {}

    bool x, y, z;
};

struct BoundaryValueProblem {
    VectorField body_force = {};                      // [N/m^3]; empty: none
    VectorField displacement = {};                    // [m], where it is held; empty: zero
    std::function<Held(const pbs::Vec3&)> held = {};  // of the boundary nodes; empty: all are
    int element_order = 2;
    LinearSolver solver = LinearSolver::cholmod;
    std::vector<Traction> tractions = {};  // elsewhere the boundary is free
    Formulation formulation = Formulation::displacement;
};

struct BoundaryValueSolution {
    std::shared_ptr<const SimplexSpace> space;
    Eigen::VectorXd displacement;  // [m], #dofs
    double residual = 0.0;
    Eigen::VectorXd load;    // of body force and tractions [N], #dofs
    std::vector<bool> held;  // #dofs
    Formulation formulation = Formulation::displacement;
    Eigen::VectorXd pressure_pa = {};  // lambda div u at the vertices, #V, with taylor_hood, else empty

    ErrorNorms errors(const VectorField& exact, const GradientField& exact_gradient) const;
    double largest_nodal_error(const VectorField& exact) const;  // [m]
    double strain_energy_j(const ElasticMaterial& material) const;
    double work_of_load_j() const { return load.dot(displacement); }  // over the total force: the mean displacement along it

    pbs::Vec3 displacement_at(const pbs::Vec3& point) const;                                   // [m], of the nearest node
    Eigen::Matrix3d stress_at(const pbs::Vec3& point, const ElasticMaterial& material) const;  // [Pa], of the nearest vertex: the mean
                                                                                               // over the tets that meet there
};

BoundaryValueSolution solve(const pbs::TetMesh& mesh, const ElasticMaterial& material, const BoundaryValueProblem& problem);

// What a problem says of a space.
struct PrescribedData {
    std::vector<bool> held;  // #dofs
    Eigen::VectorXd values;  // [m], #dofs
};
PrescribedData prescribed_data(const SimplexSpace& space, const BoundaryValueProblem& problem);
Eigen::VectorXd external_load(const SimplexSpace& space, const BoundaryValueProblem& problem);  // [N], #dofs
int nearest_node(const SimplexSpace& space, const pbs::Vec3& point);

}  // namespace reference_fem
