// The sequence in which packed code projects constraints, and the batches of sixteen in which it does so (batch.hpp).
//   const std::vector<PackedConstraint> tets = packed_tets(corners);
//   for (const auto& batch : BatchScheduler(vertices).schedule(tets)) ...   // indices into tets, at most sixteen
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/packed/batch.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace pbs {

// A constraint that one lane projects.
struct PackedConstraint {
    ConstraintKind kind;        // says how many entries of `vertex` count
    std::array<int, 4> vertex;  // of the mesh
    int constraint;             // index into its class
};

// The constraints of a class in the order given: the vertices of each stretch constraint, and of each volume
// constraint.
std::vector<PackedConstraint> packed_edges(const std::vector<std::array<int, 2>>& edges);
std::vector<PackedConstraint> packed_tets(const std::vector<std::array<int, 4>>& tets);

// The sequence in which order `ordered` projects the constraints of a class: colour by colour.
// Gauss-Seidel projections leave behind what the neighbours that follow undo. Neighbours are tets that share a face,
// then those that share an edge, then those that share a vertex. Where neighbours follow each other like the tets of a
// sweep through the body, each one is undone by half of its neighbours. By colours, those of the last colour are undone
// by none. Measured after 24 iterations on the limb, two tapered limbs and the human, the absolute volume change is on
// average 7 % and at least 1 % below the median of random sequences; that of sweeps is on average 3 % above. The page
// of the study `timing` has the table.
//
// The place of each constraint in the sequence, #constraints. constraints: of one class, of a mesh of so many vertices.
// Three colourings decide, one after the other: by shared faces (three vertices, ascending), by shared edges (two,
// descending), by shared vertices (one, ascending). Each gives a constraint the first
// colour that no earlier constraint next to it has, in the order given. The directions, and leaving the second
// colouring out for larger constraints, are the ones that measured best. Constraints of the same colours share no
// vertex, so that their order among themselves changes nothing; it is the order given.
std::vector<int> projection_sequence(const std::vector<PackedConstraint>& constraints, int vertices);

// The constraints of each slab (vertex_order.hpp), by indices: a constraint belongs to the slab of the first of its
// vertices in memory. Clusters of about so many neighbours, which stay in a cache, follow each other, and each cluster
// goes by projection_sequence.
using SlabClusters = std::vector<std::vector<int>>;
std::vector<SlabClusters> clusters_of_slabs(const std::vector<PackedConstraint>& constraints, const VertexOrder& order,
                                            int cluster_size);

// Constraints of constraints in batches: no two of a batch share a vertex, and none shares one with the batch before
// (with the two before, where that can be had), so that a kernel may load ahead and need not wait for its own stores.
// Keeps its memory from one cluster to the next; a cluster leaves no trace for the next.
class BatchScheduler {
public:
    // vertices: #V of the mesh.
    explicit BatchScheduler(int vertices)
        : last_batch_(vertices, never), waiting_(vertices), chain_at_vertex_(vertices, 0)
    {
    }

    // constraints: of one kind. Returns indices into `constraints`, at most batch_size a batch. Constraints that share
    // a vertex keep the order given, so that the batches project to the bit what the constraints project one after the
    // other. Constraints on which the longest chains wait come first. Batches may be short, and empty where one must
    // pass before a vertex may be touched again. A long chain of constraints, each of which shares a vertex with the
    // next, has a batch and a pause for each; projection_sequence leaves none.
    std::vector<std::vector<int>> schedule(const std::vector<PackedConstraint>& constraints);

private:
    static constexpr int never = -1000;

    std::vector<int> begin(const std::vector<PackedConstraint>& constraints);
    void take_turn(int constraint, std::vector<int>& freed);
    void finish(const PackedConstraint& constraint, int batch, std::vector<int>& freed);
    bool rests(const PackedConstraint& constraint, int since) const;

    int corners_ = 0;
    std::vector<int> last_batch_;            // that touched each vertex
    std::vector<std::vector<int>> waiting_;  // constraints at each vertex, the next one last
    // the longest chain of constraints that begins with a constraint, or is left at a vertex
    std::vector<int> chain_of_constraint_, chain_at_vertex_;
    // of each constraint, the number of its vertices at which it is the next one
    std::vector<int> turns_;
};

// The tets of a mesh for solvers that take sixteen of them at once: the order of the vertices, the tets of each slab,
// and batches of them.
class TetSlabs {
public:
    // threads: among which the slabs are shared, where there are enough of them.
    TetSlabs(const Tets& tets, int vertices, int threads);

    const VertexOrder& order() const { return order_; }
    int rows() const { return rows_; }  // of vertices in whole batches and, behind them, of the dummies of each slab
    int slabs() const { return order_.slabs(); }
    // its tets, by clusters_of_slabs, so that batches fill
    const std::vector<int>& of_slab(int slab) const { return of_slab_[slab]; }
    // the tets of each batch, by BatchScheduler
    std::vector<std::vector<int>> batches(const std::vector<int>& tets) const;
    // Sets 4 * row of the corners in each lane of these batches of a slab, those of dummies where there is no tet, and
    // calls set_tet(batch, lane, tet), with the number of the batch, where there is one.
    template <typename Batch, typename SetTet>
    void fill(int slab, const std::vector<std::vector<int>>& members, std::vector<Batch>& batches,
              const SetTet& set_tet) const;
    void for_each(const std::function<void(int)>& task) const { parallel_.for_each_slab(slabs(), task); }

private:
    std::array<std::uint32_t, 4> offset(int slab, int lane, int tet) const;  // tet -1: of the lane's dummies

    std::vector<PackedConstraint> tets_;
    VertexOrder order_;
    int rows_;
    Parallel parallel_;
    std::vector<std::vector<int>> of_slab_;
};

template <typename Batch, typename SetTet>
void TetSlabs::fill(int slab, const std::vector<std::vector<int>>& members, std::vector<Batch>& batches,
                    const SetTet& set_tet) const
{
    batches.resize(members.size());
    for (std::size_t b = 0; b < batches.size(); ++b)
        for (int lane = 0; lane < batch_size; ++lane) {
            const int tet = lane < static_cast<int>(members[b].size()) ? members[b][lane] : -1;
            const auto corners = offset(slab, lane, tet);
            for (int i = 0; i < 4; ++i) batches[b].offset[i][lane] = corners[i];
            if (tet >= 0) set_tet(static_cast<int>(b), lane, tet);
        }
}

}  // namespace pbs
