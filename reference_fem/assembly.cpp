#include "reference_fem/assembly.hpp"

#include "pbs/system/deferred_sigterm.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>

#include <algorithm>

namespace reference_fem {

// deal.II's side of a SimplexSpace. The requirements of deal.II 9.4.1 on tets: MappingFE everywhere (the default
// mapping crashes), QGaussSimplex<3>(n) with n <= 4. Stays where it is made: the handler refers to the triangulation.
struct SimplexSpace::Elements {
    // 1 or 2; the triangulation is filled later, by the space.
    explicit Elements(int element_order)
        : element(dealii::FE_SimplexP<3>(element_order), 3),
          mapping(dealii::FE_SimplexP<3>(1)),
          dof_handler(triangulation)
    {
    }

    dealii::Triangulation<3> triangulation;  // cell t is tet t of the mesh
    dealii::FESystem<3> element;             // three components of FE_SimplexP
    dealii::MappingFE<3> mapping;            // of straight tets
    dealii::DoFHandler<3> dof_handler;       // renumbered: 3 n + c is component c at node n
};

namespace {

void fill_triangulation(const pbs::TetMesh& mesh, dealii::Triangulation<3>& triangulation)
{
    std::vector<dealii::Point<3>> vertices;
    vertices.reserve(mesh.rest.rows());
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v)
        vertices.emplace_back(mesh.rest(v, 0), mesh.rest(v, 1), mesh.rest(v, 2));
    std::vector<dealii::CellData<3>> cells(mesh.tets.rows(), dealii::CellData<3>(4));
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) cells[t].vertices[corner] = mesh.tets(t, corner);
    triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

using DofIndices = std::vector<dealii::types::global_dof_index>;

pbs::Vec3 to_vec3(const dealii::Tensor<1, 3>& v)
{
    return {v[0], v[1], v[2]};
}

// Calls visit(values, dofs) on every tet, in the mesh's order.
template <typename Visit>
void for_each_tet(const SimplexSpace& space, const dealii::Quadrature<3>& quadrature, dealii::UpdateFlags update,
                  Visit visit)
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
    const auto update = dealii::update_values | dealii::update_quadrature_points | dealii::update_normal_vectors |
                        dealii::update_JxW_values;
    dealii::FEFaceValues<3> values(elements.mapping, elements.element,
                                   dealii::QGaussSimplex<2>(space.element_order() + 1), update);
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
pbs::Vec3 value_at(const dealii::FEValues<3>& values, const DofIndices& dofs, const Eigen::VectorXd& displacement,
                   unsigned int q)
{
    pbs::Vec3 value = pbs::Vec3::Zero();
    for (const unsigned int i : values.dof_indices())
        value(values.get_fe().system_to_component_index(i).first) += displacement(dofs[i]) * values.shape_value(i, q);
    return value;
}

// grad u_h at quadrature point q: (i, j) = d u_i / d x_j.
Eigen::Matrix3d gradient_at(const dealii::FEValues<3>& values, const DofIndices& dofs,
                            const Eigen::VectorXd& displacement, unsigned int q)
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
    for_each_tet(
        space, quadrature, dealii::update_gradients | dealii::update_JxW_values,
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

// Nodes that share a tet with each node, itself included, increasing.
std::vector<std::vector<int>> neighbours(const TetNodes& tet_nodes, int nodes)
{
    std::vector<std::vector<int>> adjacent(nodes);
    for (const auto& tet : tet_nodes.rowwise())
        for (const int node : tet) adjacent[node].insert(adjacent[node].end(), tet.begin(), tet.end());
    for (auto& of_node : adjacent) {
        std::sort(of_node.begin(), of_node.end());
        of_node.erase(std::unique(of_node.begin(), of_node.end()), of_node.end());
    }
    return adjacent;
}

}  // namespace

SimplexSpace::SimplexSpace(const pbs::TetMesh& mesh, int element_order) : element_order_(element_order)
{
    require(element_order == 1 || element_order == 2, "element_order", element_order, "expected 1 or 2");
    check_mesh(mesh);
    const pbs::DeferredSigterm deferred;  // deal.II starts threads
    elements_ = std::make_unique<Elements>(element_order);
    fill_triangulation(mesh, elements_->triangulation);
    elements_->dof_handler.distribute_dofs(elements_->element);
    number_nodes(mesh);
}

SimplexSpace::~SimplexSpace() = default;

void SimplexSpace::number_nodes(const pbs::TetMesh& mesh)
{
    const auto& element = elements_->element;
    auto& dof_handler = elements_->dof_handler;
    const int per_tet = static_cast<int>(element.n_dofs_per_cell()) / 3;
    tet_nodes_.resize(mesh.tets.rows(), per_tet);
    node_positions_.resize(dof_handler.n_dofs() / 3, 3);
    node_positions_.topRows(mesh.rest.rows()) = mesh.rest;

    int next_node = static_cast<int>(mesh.rest.rows());
    std::vector<dealii::types::global_dof_index> renumbered(dof_handler.n_dofs(), dealii::numbers::invalid_dof_index);
    std::vector<dealii::types::global_dof_index> dofs(element.n_dofs_per_cell());
    for (const auto& cell : dof_handler.active_cell_iterators()) {
        const auto t = static_cast<Eigen::Index>(cell->active_cell_index());
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i) {
            const auto [component, node_in_tet] = element.system_to_component_index(i);
            auto& number = renumbered[dofs[i]];
            if (node_in_tet < 4)
                number = 3 * cell->vertex_index(node_in_tet) + component;
            else if (number == dealii::numbers::invalid_dof_index)
                number = component == 0
                             ? 3 * next_node++
                             : renumbered[dofs[element.component_to_system_index(0, node_in_tet)]] + component;
            tet_nodes_(t, node_in_tet) = static_cast<int>(number / 3);
            if (node_in_tet >= 4) {
                const auto middle = cell->line(node_in_tet - 4)->center();
                node_positions_.row(number / 3) << middle[0], middle[1], middle[2];
            }
        }
    }
    if (tet_nodes_.leftCols(4) != mesh.tets) throw std::logic_error("deal.II reordered the corners of a tet");
    dof_handler.renumber_dofs(renumbered);
}

Eigen::VectorXd SimplexSpace::shape_values(const pbs::Vec3& barycentric) const
{
    const auto& scalar = elements_->element.base_element(0);
    const dealii::Point<3> point(barycentric.x(), barycentric.y(), barycentric.z());
    Eigen::VectorXd values(scalar.n_dofs_per_cell());
    for (unsigned int i = 0; i < scalar.n_dofs_per_cell(); ++i) values(i) = scalar.shape_value(i, point);
    return values;
}

pbs::Positions SimplexSpace::from_vertices(const pbs::Positions& at_vertices) const
{
    pbs::Positions on_nodes(nodes(), 3);
    on_nodes.topRows(at_vertices.rows()) = at_vertices;
    for (Eigen::Index t = 0; t < tet_nodes_.rows(); ++t)
        for (Eigen::Index middle = 4; middle < tet_nodes_.cols(); ++middle) {
            const auto& [first, second] = edge_corners[middle - 4];
            on_nodes.row(tet_nodes_(t, middle)) =
                (at_vertices.row(tet_nodes_(t, first)) + at_vertices.row(tet_nodes_(t, second))) / 2.0;
        }
    return on_nodes;
}

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
    return tables_at(space, dealii::Quadrature<3>(
                                points, std::vector<double>(quadrature.weights.begin(), quadrature.weights.end())));
}

Eigen::VectorXd load_vector(const SimplexSpace& space, const VectorField& body_force)
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs());
    const auto update = dealii::update_values | dealii::update_quadrature_points | dealii::update_JxW_values;
    for_each_tet(space, space.element_order() + 1, update,
                 [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
                     for (const unsigned int q : values.quadrature_point_indices()) {
                         const pbs::Vec3 force = body_force(to_vec3(values.quadrature_point(q)));
                         for (const unsigned int i : values.dof_indices())
                             load(dofs[i]) += force(values.get_fe().system_to_component_index(i).first) *
                                              values.shape_value(i, q) * values.JxW(q);
                     }
                 });
    return load;
}

Eigen::VectorXd traction_load(const SimplexSpace& space, const Traction& traction)
{
    Eigen::VectorXd load = Eigen::VectorXd::Zero(space.dofs());
    for_each_boundary_face(space, traction.on, [&](const dealii::FEFaceValues<3>& values, const DofIndices& dofs) {
        for (const unsigned int q : values.quadrature_point_indices()) {
            const pbs::Vec3 force =
                traction.force(to_vec3(values.quadrature_point(q)), to_vec3(values.normal_vector(q)));
            for (const unsigned int i : values.dof_indices())
                load(dofs[i]) += force(values.get_fe().system_to_component_index(i).first) * values.shape_value(i, q) *
                                 values.JxW(q);
        }
    });
    return load;
}

Eigen::Matrix3d gradient_at_vertex(const SimplexSpace& space, const Eigen::VectorXd& displacement, int vertex)
{
    std::vector<dealii::Point<3>> corners;
    for (unsigned int corner = 0; corner < 4; ++corner)
        corners.push_back(dealii::ReferenceCells::Tetrahedron.vertex<3>(corner));
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
    for_each_tet(
        space, space.element_order(), dealii::update_gradients | dealii::update_JxW_values,
        [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
            for (const unsigned int q : values.quadrature_point_indices()) {
                const Eigen::Matrix3d gradient = gradient_at(values, dofs, displacement, q);
                const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2.0;
                const double dilatation = strain.trace();
                energy += (material.lambda_pa / 2.0 * dilatation * dilatation + material.mu_pa * strain.squaredNorm()) *
                          values.JxW(q);
            }
        });
    return energy;
}

ErrorNorms error_norms(const SimplexSpace& space, const Eigen::VectorXd& displacement, const VectorField& exact,
                       const GradientField& exact_gradient)
{
    ErrorNorms squared;
    const auto update =
        dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points | dealii::update_JxW_values;
    for_each_tet(space, 4, update, [&](const dealii::FEValues<3>& values, const DofIndices& dofs) {
        for (const unsigned int q : values.quadrature_point_indices()) {
            const pbs::Vec3 point = to_vec3(values.quadrature_point(q));
            squared.l2 += (exact(point) - value_at(values, dofs, displacement, q)).squaredNorm() * values.JxW(q);
            squared.h1_seminorm +=
                (exact_gradient(point) - gradient_at(values, dofs, displacement, q)).squaredNorm() * values.JxW(q);
        }
    });
    return {std::sqrt(squared.l2), std::sqrt(squared.h1_seminorm)};
}

NodalMatrix::NodalMatrix(const SimplexSpace& space) : matrix_(space.dofs(), space.dofs()), tet_nodes_(space.tet_nodes())
{
    set_pattern(neighbours(tet_nodes_, space.nodes()));
}

void NodalMatrix::set_pattern(std::vector<std::vector<int>> rows_of_column)
{
    std::size_t blocks = 0;
    for (const auto& rows : rows_of_column) blocks += rows.size();
    matrix_.setZero();
    matrix_.reserve(9 * blocks);
    for (int column = 0; column < matrix_.cols(); ++column) {
        matrix_.startVec(column);
        for (const int row_node : rows_of_column[column / 3])
            for (int c = 0; c < 3; ++c) matrix_.insertBack(3 * row_node + c, column) = 0.0;
    }
    matrix_.finalize();

    tet_places_.clear();
    tet_places_.reserve(tet_nodes_.size() * tet_nodes_.cols());
    for (const auto& tet : tet_nodes_.rowwise())
        for (const int row_node : tet)
            for (const int column_node : tet) tet_places_.push_back(place(row_node, column_node));
}

bool NodalMatrix::couple(const std::vector<NodePair>& pairs)
{
    if (std::all_of(pairs.begin(), pairs.end(), [&](const NodePair& pair) { return has_place(pair[0], pair[1]); }))
        return false;
    auto rows = neighbours(tet_nodes_, static_cast<int>(matrix_.cols()) / 3);
    for (const auto& [one, other] : pairs) {
        rows[one].push_back(other);
        rows[other].push_back(one);
    }
    for (auto& of_column : rows) {
        std::sort(of_column.begin(), of_column.end());
        of_column.erase(std::unique(of_column.begin(), of_column.end()), of_column.end());
    }
    set_pattern(std::move(rows));
    return true;
}

SparseMatrix::StorageIndex NodalMatrix::place(int row_node, int column_node) const
{
    const auto* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column_node];
    const auto* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * column_node + 1];
    return std::lower_bound(begin, end, 3 * row_node) - begin;
}

bool NodalMatrix::has_place(int row_node, int column_node) const
{
    const auto at = matrix_.outerIndexPtr()[3 * column_node] + place(row_node, column_node);
    return at < matrix_.outerIndexPtr()[3 * column_node + 1] && matrix_.innerIndexPtr()[at] == 3 * row_node;
}

template <typename Block>
void NodalMatrix::add_at(SparseMatrix::StorageIndex place, int column_node, const Block& block)
{
    for (int c = 0; c < 3; ++c) {
        double* column = matrix_.valuePtr() + matrix_.outerIndexPtr()[3 * column_node + c] + place;
        for (int r = 0; r < 3; ++r) column[r] += block(r, c);
    }
}

void NodalMatrix::add_block(int row_node, int column_node, const Eigen::Matrix3d& block)
{
    add_at(place(row_node, column_node), column_node, block);
}

void NodalMatrix::add_tet(Eigen::Index tet, const Eigen::Ref<const Eigen::MatrixXd>& values)
{
    const Eigen::Index nodes = tet_nodes_.cols();
    const auto* places = tet_places_.data() + tet * nodes * nodes;
    for (Eigen::Index a = 0; a < nodes; ++a)
        for (Eigen::Index b = 0; b < nodes; ++b)
            add_at(places[a * nodes + b], tet_nodes_(tet, b), values.block<3, 3>(3 * a, 3 * b));
}

// Both walk along a column; the rows of the tets are among those of the pattern.
void NodalMatrix::add(const SparseMatrix& of_tets, double factor)
{
    for (Eigen::Index column = 0; column < matrix_.cols(); ++column) {
        SparseMatrix::InnerIterator here(matrix_, column);
        for (SparseMatrix::InnerIterator entry(of_tets, column); entry; ++entry, ++here) {
            while (here.row() != entry.row()) ++here;
            here.valueRef() += factor * entry.value();
        }
    }
}

void NodalMatrix::add_isotropic(const SparseMatrix& of_nodes, double factor)
{
    for (Eigen::Index node = 0; node < of_nodes.cols(); ++node)
        for (int c = 0; c < 3; ++c) {
            SparseMatrix::InnerIterator here(matrix_, 3 * node + c);
            for (SparseMatrix::InnerIterator entry(of_nodes, node); entry; ++entry, ++here) {
                while (here.row() != 3 * entry.row() + c) ++here;
                here.valueRef() += factor * entry.value();
            }
        }
}

Lame lame_parameters(double young_pa, double poisson)
{
    require(young_pa > 0.0 && std::isfinite(young_pa), "young_pa", young_pa, "expected young_pa > 0");
    require(poisson > -1.0 && poisson < 0.5, "poisson", poisson, "expected -1 < poisson < 0.5");
    return {young_pa * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young_pa / (2.0 * (1.0 + poisson))};
}

void check_mesh(const pbs::TetMesh& mesh)
{
    require(mesh.tets.rows() > 0, "tets", mesh.tets.rows(), "expected at least one");
    require(mesh.rest.allFinite(), "rest positions", "not a number or infinite", "expected finite coordinates");
    std::vector<bool> used(mesh.rest.rows(), false);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (const int vertex : mesh.tets.row(t)) {
            require(vertex >= 0 && vertex < mesh.rest.rows(), "tet vertex", vertex,
                    "expected an index below the number of vertices");
            used[vertex] = true;
        }
    pbs::positive_volumes(mesh.rest, mesh.tets);
    for (std::size_t v = 0; v < used.size(); ++v)
        require(used[v], "vertex", v, "expected every vertex to belong to a tet");
}

}  // namespace reference_fem
