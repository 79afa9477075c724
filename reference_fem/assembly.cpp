#include "reference_fem/assembly.hpp"

#include "reference_fem/element_tables.hpp"
#include "reference_fem/simplex_elements.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>

namespace reference_fem {
namespace {

using DofIndices = std::vector<dealii::types::global_dof_index>;

pbs::Vec3 to_vec3(const dealii::Tensor<1, 3>& v)
{
    return {v[0], v[1], v[2]};
}

// Calls visit(values, dofs) on every tet, in the mesh's order.
template <typename Visit>
void for_each_tet(const SimplexSpace& space, const dealii::Quadrature<3>& quadrature, dealii::UpdateFlags update, Visit visit)
{
    const auto& elements = space.elements();
    dealii::FEValues<3> values(elements.mapping, elements.element, quadrature, update);
    DofIndices dofs(elements.element.n_dofs_per_cell());
    for (const auto& cell : elements.dof_handler.active_cell_iterators()) {
        values.reinit(cell);
        cell->get_dof_indices(dofs);
        visit(values, dofs);
    }
}

template <typename Visit>
void for_each_tet(const SimplexSpace& space, int quadrature_points_1d, dealii::UpdateFlags update, Visit visit)
{
    for_each_tet(space, dealii::QGaussSimplex<3>(quadrature_points_1d), update, visit);
}

// Calls visit(values, dofs) on every boundary face whose centre is `on`.
template <typename Visit>
void for_each_boundary_face(const SimplexSpace& space, const std::function<bool(const pbs::Vec3&)>& on, Visit visit)
{
    const auto& elements = space.elements();
    const auto update =
        dealii::update_values | dealii::update_quadrature_points | dealii::update_normal_vectors | dealii::update_JxW_values;
    dealii::FEFaceValues<3> values(elements.mapping, elements.element, dealii::QGaussSimplex<2>(space.element_order() + 1), update);
    DofIndices dofs(elements.element.n_dofs_per_cell());
    for (const auto& cell : elements.dof_handler.active_cell_iterators())
        for (const unsigned int face : cell->face_indices()) {
            if (!cell->face(face)->at_boundary() || !on(to_vec3(cell->face(face)->center()))) continue;
            values.reinit(cell, face);
            cell->get_dof_indices(dofs);
            visit(values, dofs);
        }
}

// u_h at quadrature point q.
pbs::Vec3 value_at(const dealii::FEValues<3>& values, const DofIndices& dofs, const Eigen::VectorXd& displacement, unsigned int q)
{
    pbs::Vec3 value = pbs::Vec3::Zero();
    for (const unsigned int i : values.dof_indices())
        value(values.get_fe().system_to_component_index(i).first) += displacement(dofs[i]) * values.shape_value(i, q);
    return value;
}

// grad u_h at quadrature point q: (i, j) = d u_i / d x_j.
Eigen::Matrix3d gradient_at(const dealii::FEValues<3>& values, const DofIndices& dofs, const Eigen::VectorXd& displacement, unsigned int q)
{
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (const unsigned int i : values.dof_indices())
        gradient.row(values.get_fe().system_to_component_index(i).first) +=
            displacement(dofs[i]) * to_vec3(values.shape_grad(i, q)).transpose();
    return gradient;
}

ElementTables tables_at(const SimplexSpace& space, const dealii::Quadrature<3>& quadrature)
{
    const Eigen::Index tets = space.tet_nodes().rows(), nodes = space.tet_nodes().cols();
    const auto points = static_cast<Eigen::Index>(quadrature.size());
    ElementTables tables{static_cast<int>(nodes), static_cast<int>(points), Eigen::VectorXd(tets * points),
                         pbs::Positions(tets * points * nodes, 3)};
    Eigen::Index point = 0;
    for_each_tet(space, quadrature, dealii::update_gradients | dealii::update_JxW_values,
                 [&](const dealii::FEValues<3>& values, const DofIndices&) {
                     for (const unsigned int q : values.quadrature_point_indices()) {
                         tables.weights(point) = values.JxW(q);
                         for (Eigen::Index a = 0; a < nodes; ++a)
                             tables.shape_gradients.row(point * nodes + a) =
                                 to_vec3(values.shape_grad(values.get_fe().component_to_system_index(0, a), q)).transpose();
                         ++point;
                     }
                 });
    return tables;
}

}  // namespace

SparseMatrix mass_matrix(const SimplexSpace& space, double density_kg_m3)
{
    const Eigen::Index per_tet = space.tet_nodes().cols();
    std::vector<Eigen::Triplet<double, SparseMatrix::StorageIndex>> entries;
    entries.reserve(space.tet_nodes().rows() * per_tet * per_tet);
    Eigen::Index tet = 0;
    for_each_tet(space, space.element_order() + 1, dealii::update_values | dealii::update_JxW_values,
                 [&](const dealii::FEValues<3>& values, const DofIndices&) {
                     const auto nodes = space.tet_nodes().row(tet++);
                     const auto& element = values.get_fe();
                     for (Eigen::Index a = 0; a < per_tet; ++a)
                         for (Eigen::Index b = 0; b < per_tet; ++b) {
                             double mass = 0.0;
                             for (const unsigned int q : values.quadrature_point_indices())
                                 mass += values.shape_value(element.component_to_system_index(0, a), q) *
                                         values.shape_value(element.component_to_system_index(0, b), q) * values.JxW(q);
                             entries.emplace_back(nodes(a), nodes(b), density_kg_m3 * mass);
                         }
                 });
    SparseMatrix mass(space.nodes(), space.nodes());
    mass.setFromTriplets(entries.begin(), entries.end());
    return mass;
}

ElementTables element_tables(const SimplexSpace& space, int points_1d)
{
    return tables_at(space, dealii::QGaussSimplex<3>(points_1d));
}

ElementTables element_tables(const SimplexSpace& space, const TetQuadrature& quadrature)
{
    std::vector<dealii::Point<3>> points;
    for (const auto& point : quadrature.points.rowwise()) points.emplace_back(point(0), point(1), point(2));
    return tables_at(space, dealii::Quadrature<3>(points, std::vector<double>(quadrature.weights.begin(), quadrature.weights.end())));
}

Eigen::VectorXd load_vector(const SimplexSpace& space, const VectorField& body_force)
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs());
    const auto update = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    for_each_tet(space, space.element_order() + 1, update, [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
        for (const unsigned int q : values.quadrature_point_indices()) {
            const pbs::Vec3 force = body_force(to_vec3(values.quadrature_point(q)));
            for (const unsigned int i : values.dof_indices())
                load(dofs[i]) += force(values.get_fe().system_to_component_index(i).first) * values.shape_value(i, q) * values.JxW(q);
        }
    });
    return load;
}

Eigen::VectorXd traction_load(const SimplexSpace& space, const Traction& traction)
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs());
    for_each_boundary_face(space, traction.on, [&](const dealii::FEFaceValues<3>& values, const DofIndices& dofs) {
        for (const unsigned int q : values.quadrature_point_indices()) {
            const pbs::Vec3 force = traction.force(to_vec3(values.quadrature_point(q)), to_vec3(values.normal_vector(q)));
            for (const unsigned int i : values.dof_indices())
                load(dofs[i]) += force(values.get_fe().system_to_component_index(i).first) * values.shape_value(i, q) * values.JxW(q);
        }
    });
    return load;
}

Eigen::Matrix3d gradient_at_vertex(const SimplexSpace& space, const Eigen::VectorXd& displacement, int vertex)
{
    std::vector<dealii::Point<3>> corners;
    for (unsigned int corner = 0; corner < 4; ++corner) corners.push_back(dealii::ReferenceCells::Tetrahedron.vertex<3>(corner));
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    int meeting = 0;
    Eigen::Index tet = 0;
    for_each_tet(space, dealii::Quadrature<3>(corners), dealii::update_gradients,
                 [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
                     const auto nodes = space.tet_nodes().row(tet++);
                     for (int corner = 0; corner < 4; ++corner) {
                         if (nodes(corner) != vertex) continue;
                         sum += gradient_at(values, dofs, displacement, corner);
                         ++meeting;
                     }
                 });
    return sum / meeting;
}

double strain_energy(const SimplexSpace& space, const Lame& material, const Eigen::VectorXd& displacement)
{
    double energy = 0.0;
    for_each_tet(space, space.element_order(), dealii::update_gradients | dealii::update_JxW_values,
                 [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
                     for (const unsigned int q : values.quadrature_point_indices()) {
                         const Eigen::Matrix3d gradient = gradient_at(values, dofs, displacement, q);
                         const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2.0;
                         const double dilatation = strain.trace();
                         energy +=
                             (material.lambda_pa / 2.0 * dilatation * dilatation + material.mu_pa * strain.squaredNorm()) * values.JxW(q);
                     }
                 });
    return energy;
}

ErrorNorms error_norms(const SimplexSpace& space, const Eigen::VectorXd& displacement, const VectorField& exact,
                       const GradientField& exact_gradient)
{
    ErrorNorms squared;
    const auto update = dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values;
    for_each_tet(space, 4, update, [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
        for (const unsigned int q : values.quadrature_point_indices()) {
            const pbs::Vec3 point = to_vec3(values.quadrature_point(q));
            squared.l2 += (exact(point) - value_at(values, dofs, displacement, q)).squaredNorm() * values.JxW(q);
            squared.h1_seminorm += (exact_gradient(point) - gradient_at(values, dofs, displacement, q)).squaredNorm() * values.JxW(q);
        }
    });
    return {std::sqrt(squared.l2), std::sqrt(squared.h1_seminorm)};
}

}  // namespace reference_fem
