// Integrals over the tets: stiffness, load, strain energy, error norms. One assembly serves both the reference and its verification.
#pragma once

#include "reference_fem/material.hpp"
#include "reference_fem/simplex_space.hpp"
#include "reference_fem/sparse_matrix.hpp"

#include <functional>

namespace reference_fem {

using VectorField = std::function<pbs::Vec3(const pbs::Vec3&)>;          // of a rest point [m]; unit by use: N/m^3, m
using GradientField = std::function<Eigen::Matrix3d(const pbs::Vec3&)>;  // (i, j): d u_i / d x_j at a rest point [m]

// K_ij = integral of lambda div(phi_i) div(phi_j) + 2 mu eps(phi_i) : eps(phi_j) [N/m], #dofs x #dofs; exact on straight tets.
SparseMatrix stiffness_matrix(const SimplexSpace& space, const Lame& material);

// M_ij = integral of density phi_i phi_j [kg], #nodes x #nodes: the consistent mass, the same for each component; exact on straight tets.
SparseMatrix mass_matrix(const SimplexSpace& space, double density_kg_m3);

// f_i = integral of body_force . phi_i [N], #dofs; body_force in N/m^3.
Eigen::VectorXd load_vector(const SimplexSpace& space, const VectorField& body_force);

// Forces on the boundary faces whose centre is `on`; `force` [N/m^2] may follow the outward unit normal.
struct Traction {
    std::function<bool(const pbs::Vec3& face_centre)> on;  // called once per boundary face, at its rest centre [m]
    std::function<pbs::Vec3(const pbs::Vec3& point, const pbs::Vec3& normal)> force;  // called at quadrature points [m]
};

// f_i = integral of force . phi_i over those faces [N], #dofs.
Eigen::VectorXd traction_load(const SimplexSpace& space, const Traction& traction);

// (i, j) = d u_i / d x_j at a vertex of the mesh, each tet that meets there with its own: their mean.
Eigen::Matrix3d gradient_at_vertex(const SimplexSpace& space, const Eigen::VectorXd& displacement, int vertex);

// Integral of lambda / 2 tr(eps)^2 + mu eps : eps [J] of a displacement [m], #dofs.
double strain_energy(const SimplexSpace& space, const Lame& material, const Eigen::VectorXd& displacement);

// Distance of a displacement u_h from the exact u over the whole volume.
struct ErrorNorms {
    double l2 = 0.0;           // sqrt of the integral of |u - u_h|^2 [m^(5/2)]
    double h1_seminorm = 0.0;  // sqrt of the integral of |grad u - grad u_h|^2 [m^(3/2)]
};
// displacement [m], #dofs. By quadrature with 4 points a direction, exact to degree 7.
ErrorNorms error_norms(const SimplexSpace& space, const Eigen::VectorXd& displacement, const VectorField& exact,
                       const GradientField& exact_gradient);

}  // namespace reference_fem
