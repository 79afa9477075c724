#include "reference_fem/distributed/distributed_space.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <stdexcept>

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
void distribute(const pbs::TetMesh& mesh, const std::vector<int>& held_vertices, const std::vector<int>& pulled_vertices,
                dealii::parallel::fullydistributed::Triangulation<3>& triangulation)
{
    const auto ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const auto build = [&](Triangulation<3>& whole) {
        fill(mesh, whole);
        mark_boundary(flags(held_vertices, mesh.rest.rows()), flags(pulled_vertices, mesh.rest.rows()), whole);
    };
    const auto cut = [&](Triangulation<3>& whole, const MPI_Comm&, unsigned int) {
        dealii::GridTools::partition_triangulation(ranks, whole, dealii::SparsityTools::Partitioner::metis);
    };
    triangulation.create_triangulation(dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<3, 3>(
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
    const auto corners = {cell->face(face)->vertex_index(0), cell->face(face)->vertex_index(1), cell->face(face)->vertex_index(2)};
    return std::ranges::count(corners, cell->vertex_index(first)) && std::ranges::count(corners, cell->vertex_index(second));
}

}  // namespace reference_fem
