// deal.II's side of the distributed solver: the tets spread over the ranks, each rank holding its own and one layer of
// its neighbours'. To be included by distributed_space.cpp and distributed_elasticity.cpp only: it takes some 20 s to
// compile. Every rank also holds the plain arrays of the whole mesh (28 bytes a tet and vertex): tet t of them is the
// coarse cell of id t, so vertices keep their numbers.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/assembly.hpp"
#include "reference_fem/attachment.hpp"

#include <deal.II/base/index_set.h>
#include <deal.II/distributed/fully_distributed_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>

#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace reference_fem {

// Boundary ids of the triangulation: free of traction, at rest, under traction.
enum BoundaryPart : dealii::types::boundary_id { free_part = 0, held_part = 1, pulled_part = 2 };

// All ranks construct it and call it together.
struct DistributedSpace {
    using Cell = dealii::DoFHandler<3>::active_cell_iterator;  // one rank's own or its neighbour's
    using DofIndex = dealii::types::global_dof_index;          // numbered over all ranks
    using DofIndices = std::vector<DofIndex>;                  // of one cell, in deal.II's order

    // Boundary triangles with all three corners in a set belong to that part; held goes before pulled.
    DistributedSpace(const pbs::TetMesh& mesh, int element_order, const std::vector<int>& held_vertices,
                     const std::vector<int>& pulled_vertices);

    // its number in `mesh`
    Eigen::Index tet(const Cell& cell) const { return static_cast<Eigen::Index>(cell->id().get_coarse_cell_id()); }
    unsigned int nodes_per_tet() const { return element.n_dofs_per_cell() / 3; }  // 4 with P1, 10 with P2
    // The two vertices of the mesh that a tet's node lies halfway between, lower first; a vertex twice for itself.
    std::pair<int, int> ends(const Cell& cell, unsigned int node_in_tet) const;
    bool node_on_face(const Cell& cell, unsigned int node_in_tet, unsigned int face) const;  // face: 0 to 3, deal.II's

    // This rank's cells alone, each with its degrees of freedom.
    void for_each_own_cell(const std::function<void(const Cell&, const DofIndices&)>& visit) const;
    std::vector<double> rigid_body_modes() const;  // of this rank's degrees of freedom, mode after mode, #owned x 6
    // All nodes by their ends, increasing, #nodes x 2, and their values, #nodes x 3; empty on the other ranks.
    std::pair<pbs::Edges, pbs::Positions> on_rank_0(const std::function<double(DofIndex)>& value_at_own) const;

    const pbs::TetMesh& mesh;                                            // outlives the space
    dealii::parallel::fullydistributed::Triangulation<3> triangulation;  // never refined: coarse cells alone
    // three components of FE_SimplexP of order 1 or 2
    dealii::FESystem<3> element;
    dealii::MappingFE<3> mapping;       // of straight tets
    dealii::DoFHandler<3> dof_handler;  // of `element` on `triangulation`
    dealii::IndexSet owned, relevant;   // degrees of freedom of this rank; and those of its neighbours' tets
};

// The skeleton's springs by the tet that holds them, so that whoever owns the tet can add them.
// Pulls on its rest point by stiffness times (stretch - displacement there).
struct SpringInTet {
    int tet = 0;             // index into the mesh's tets
    double stiffness = 0.0;  // [N/m]
    pbs::Vec3 barycentric;   // on corners 2, 3, 4
    pbs::Vec3 stretch;       // target minus rest point [m]
};

// Sorted once; mesh, attachment and targets may go.
class SpringsInTets {
public:
    // targets [m], #S x 3. A point outside every tet is left out.
    SpringsInTets(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& targets);

    // in the attachment's order; a view, valid while this lives
    std::span<const SpringInTet> in(Eigen::Index tet) const;

private:
    std::vector<SpringInTet> springs_;  // by tet, increasing
};

}  // namespace reference_fem
