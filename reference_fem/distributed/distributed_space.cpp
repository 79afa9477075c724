#include "reference_fem/distributed/distributed_space.hpp"

#include "pbs/geometry/deferred_sigterm.hpp"
#include "reference_fem/linear_solvers.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <array>

namespace reference_fem {
namespace {

using dealii::Triangulation;

constexpr std::pair<int, int> ends_in_tet(unsigned int node_in_tet)
{
    if (node_in_tet < 4) return {node_in_tet, node_in_tet};
    return {SimplexSpace::edge_corners[node_in_tet - 4][0], SimplexSpace::edge_corners[node_in_tet - 4][1]};
}

std::vector<bool> flags(const std::vector<int>& indices, Eigen::Index size)
{
    std::vector<bool> flags(size, false);
    for (const int index : indices) flags[index] = true;
    return flags;
}

void fill(const pbs::TetMesh& mesh, Triangulation<3>& triangulation)
{
    std::vector<dealii::Point<3>> vertices;
    vertices.reserve(mesh.rest.rows());
    for (const auto& x : mesh.rest.rowwise()) vertices.emplace_back(x(0), x(1), x(2));
    std::vector<dealii::CellData<3>> cells(mesh.tets.rows(), dealii::CellData<3>(4));
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) cells[t].vertices[corner] = mesh.tets(t, corner);
    triangulation.create_triangulation(vertices, cells, dealii::SubCellData());
}

void mark_boundary(const std::vector<bool>& held, const std::vector<bool>& pulled, Triangulation<3>& triangulation)
{
    for (const auto& cell : triangulation.active_cell_iterators())
        for (const unsigned int f : cell->face_indices()) {
            const auto face = cell->face(f);
            if (!face->at_boundary()) continue;
            const auto all_in = [&](const std::vector<bool>& part) {
                return part[face->vertex_index(0)] && part[face->vertex_index(1)] && part[face->vertex_index(2)];
            };
            face->set_boundary_id(all_in(held) ? held_part : all_in(pulled) ? pulled_part : free_part);
        }
}

// Rank 0 alone builds the whole triangulation, cuts it by METIS and sends each rank its part.
void distribute(const pbs::TetMesh& mesh, const std::vector<int>& held_vertices,
                const std::vector<int>& pulled_vertices,
                dealii::parallel::fullydistributed::Triangulation<3>& triangulation)
{
    const auto ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const auto build = [&](Triangulation<3>& whole) {
        fill(mesh, whole);
        mark_boundary(flags(held_vertices, mesh.rest.rows()), flags(pulled_vertices, mesh.rest.rows()), whole);
    };
    const auto cut = [&](Triangulation<3>& whole, const MPI_Comm&, unsigned int) {
        const pbs::DeferredSigterm deferred;
        dealii::GridTools::partition_triangulation(ranks, whole, dealii::SparsityTools::Partitioner::metis);
    };
    triangulation.create_triangulation(
        dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<3, 3>(
            build, cut, MPI_COMM_WORLD, static_cast<int>(ranks)));
}

}  // namespace

DistributedSpace::DistributedSpace(const pbs::TetMesh& mesh, int element_order, const std::vector<int>& held_vertices,
                                   const std::vector<int>& pulled_vertices)
    : mesh(mesh),
      triangulation(MPI_COMM_WORLD),
      element(dealii::FE_SimplexP<3>(element_order), 3),
      mapping(dealii::FE_SimplexP<3>(1)),
      dof_handler(triangulation)
{
    distribute(mesh, held_vertices, pulled_vertices, triangulation);
    for (const auto& cell : triangulation.active_cell_iterators())
        for (const unsigned int corner : cell->vertex_indices())
            for (int axis = 0; axis < 3; ++axis)
                if (cell->vertex(corner)[axis] != mesh.rest(mesh.tets(cell->id().get_coarse_cell_id(), corner), axis))
                    throw std::logic_error("deal.II reordered the tets, or the corners of one");
    dof_handler.distribute_dofs(element);
    owned = dof_handler.locally_owned_dofs();
    dealii::DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
}

std::pair<int, int> DistributedSpace::ends(const Cell& cell, unsigned int node_in_tet) const
{
    const auto [first, second] = ends_in_tet(node_in_tet);
    return std::minmax(int(mesh.tets(tet(cell), first)), int(mesh.tets(tet(cell), second)));
}

bool DistributedSpace::node_on_face(const Cell& cell, unsigned int node_in_tet, unsigned int face) const
{
    const auto [first, second] = ends_in_tet(node_in_tet);
    const auto corners = {cell->face(face)->vertex_index(0), cell->face(face)->vertex_index(1),
                          cell->face(face)->vertex_index(2)};
    return std::ranges::count(corners, cell->vertex_index(first)) &&
           std::ranges::count(corners, cell->vertex_index(second));
}

void DistributedSpace::for_each_own_cell(const std::function<void(const Cell&, const DofIndices&)>& visit) const
{
    DofIndices dofs(element.n_dofs_per_cell());
    for (const auto& cell : dof_handler.active_cell_iterators()) {
        if (!cell->is_locally_owned()) continue;
        cell->get_dof_indices(dofs);
        visit(cell, dofs);
    }
}

std::vector<double> DistributedSpace::rigid_body_modes() const
{
    const pbs::Vec3 low = mesh.rest.colwise().minCoeff(), high = mesh.rest.colwise().maxCoeff();
    const std::size_t rows = owned.n_elements();
    std::vector<double> modes(6 * rows);
    for_each_own_cell([&](const Cell& cell, const DofIndices& dofs) {
        for (unsigned int node = 0; node < nodes_per_tet(); ++node) {
            const auto [first, second] = ends(cell, node);
            const pbs::Positions position = (mesh.rest.row(first) + mesh.rest.row(second)) / 2.0;
            const Eigen::MatrixXd of_node =
                reference_fem::rigid_body_modes(position, (low + high) / 2.0, (high - low).norm());
            for (unsigned int c = 0; c < 3; ++c) {
                const DofIndex dof = dofs[element.component_to_system_index(c, node)];
                if (!owned.is_element(dof)) continue;
                for (int mode = 0; mode < 6; ++mode)
                    modes[mode * rows + owned.index_within_set(dof)] = of_node(c, mode);
            }
        }
    });
    return modes;
}

std::pair<pbs::Edges, pbs::Positions> DistributedSpace::on_rank_0(
    const std::function<double(DofIndex)>& value_at_own) const
{
    using Row = std::array<double, 5>;  // first end, second end, value
    std::vector<bool> seen(owned.n_elements(), false);
    std::vector<Row> rows;
    for_each_own_cell([&](const Cell& cell, const DofIndices& dofs) {
        for (unsigned int node = 0; node < nodes_per_tet(); ++node) {
            const auto dof = [&](unsigned int c) { return dofs[element.component_to_system_index(c, node)]; };
            if (!owned.is_element(dof(0)) || seen[owned.index_within_set(dof(0))]) continue;
            seen[owned.index_within_set(dof(0))] = true;
            const auto [first, second] = ends(cell, node);
            rows.push_back(
                {double(first), double(second), value_at_own(dof(0)), value_at_own(dof(1)), value_at_own(dof(2))});
        }
    });
    std::vector<Row> gathered;
    for (const auto& of_rank : dealii::Utilities::MPI::gather(MPI_COMM_WORLD, rows, 0))
        gathered.insert(gathered.end(), of_rank.begin(), of_rank.end());
    std::ranges::sort(gathered);
    pbs::Edges nodes(gathered.size(), 2);
    pbs::Positions values(gathered.size(), 3);
    for (std::size_t n = 0; n < gathered.size(); ++n) {
        nodes.row(n) << static_cast<int>(gathered[n][0]), static_cast<int>(gathered[n][1]);
        values.row(n) << gathered[n][2], gathered[n][3], gathered[n][4];
    }
    return {nodes, values};
}

SpringsInTets::SpringsInTets(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& targets)
{
    if (attachment.spring_points.rows() == 0) return;
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < attachment.spring_points.rows(); ++s) {
        const pbs::Vec3 point = attachment.spring_points.row(s);
        const pbs::Location location = where.locate(point);
        if (location.tet < 0) continue;
        springs_.push_back(
            {location.tet, attachment.spring_stiffness(s), location.barycentric, targets.row(s).transpose() - point});
    }
    std::ranges::stable_sort(springs_, {}, &SpringInTet::tet);
}

std::span<const SpringInTet> SpringsInTets::in(Eigen::Index tet) const
{
    const auto range = std::ranges::equal_range(springs_, static_cast<int>(tet), {}, &SpringInTet::tet);
    return {range.begin(), range.end()};
}

}  // namespace reference_fem
