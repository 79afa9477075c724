#include "reference_fem/simplex_space.hpp"

#include "reference_fem/input_checks.hpp"
#include "reference_fem/simplex_elements.hpp"

#include <stdexcept>

namespace reference_fem {
namespace {

void fill_triangulation(const pbs::TetMesh& mesh, dealii::Triangulation<3>& triangulation)
{
    std::vector<dealii::Point<3>> vertices;
    vertices.reserve(mesh.rest.rows());
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) vertices.emplace_back(mesh.rest(v, 0), mesh.rest(v, 1), mesh.rest(v, 2));
    std::vector<dealii::CellData<3>> cells(mesh.tets.rows(), dealii::CellData<3>(4));
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) cells[t].vertices[corner] = mesh.tets(t, corner);
    triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

}  // namespace

SimplexSpace::SimplexSpace(const pbs::TetMesh& mesh, int element_order) : element_order_(element_order)
{
    require(element_order == 1 || element_order == 2, "element_order", element_order, "expected 1 or 2");
    check_mesh(mesh);
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
                number = component == 0 ? 3 * next_node++ : renumbered[dofs[element.component_to_system_index(0, node_in_tet)]] + component;
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
            on_nodes.row(tet_nodes_(t, middle)) = (at_vertices.row(tet_nodes_(t, first)) + at_vertices.row(tet_nodes_(t, second))) / 2.0;
        }
    return on_nodes;
}

}  // namespace reference_fem
