// Constraints in groups, which a lane projects one after the other before it stores their vertices (batch.hpp).
// `ordered`: groups of one. `grouped`: edges as the six of a tet, the three of a triangle, two that share a vertex, or
// alone; tets as fans of three or two round an edge, or alone. Grouping changes the order of projection and so, a
// little, what 24 iterations give.
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

inline constexpr int largest_group = 6;  // of vertices and of constraints

// The constraints that one lane projects.
struct ConstraintGroup {
    GroupKind kind;                             // says how many entries of the arrays count
    std::array<int, largest_group> vertex;      // as GroupShape<kind> counts them
    std::array<int, largest_group> constraint;  // index into the class, as GroupShape<kind>::joins; -1: there is none
};

int vertices_of(GroupKind kind);     // GroupShape<kind>::vertices
int constraints_of(GroupKind kind);  // GroupShape<kind>::constraints

// edges: vertices of each stretch constraint. tets: of each volume constraint.
std::vector<ConstraintGroup> single_edges(const std::vector<std::array<int, 2>>& edges);
// one group each, in the order given
std::vector<ConstraintGroup> single_tets(const std::vector<std::array<int, 4>>& tets);

// mesh_tets: any tets whose edges may be grouped, constrained or not.
std::vector<ConstraintGroup> grouped_edges(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets);
std::vector<ConstraintGroup> grouped_tets(const std::vector<std::array<int, 4>>& tets);  // every tet in one group

// The sequence in which the batched orders project the groups of a class: colour by colour.
// Gauss-Seidel projections leave behind what the neighbours that follow undo. Neighbours are tets that share a face,
// then those that share an edge, then those that share a vertex. Where neighbours follow each other like the tets of a
// sweep through the body, each one is undone by half of its neighbours. By colours, those of the last colour are undone
// by none. Measured after 24 iterations on the limb, two tapered limbs and the human, the absolute volume change is on
// average 7 % and at least 1 % below the median of random sequences; that of sweeps is on average 3 % above. The page
// of the study `timing` has the table.
//
// The place of each group in the sequence, #groups. groups: of one class, of a mesh of so many vertices.
// Three colourings decide, one after the other: by shared faces (three vertices, ascending), by shared edges (two,
// descending, of groups of one constraint only), by shared vertices (one, ascending). Each gives a group the first
// colour that no earlier group next to it has, in the order given. The directions, and leaving the second colouring out
// for larger groups, are the ones that measured best. Groups of the same colours share no vertex, so that their order
// among themselves changes nothing; it is the order given.
std::vector<int> projection_sequence(const std::vector<ConstraintGroup>& groups, int vertices);

// The groups of each slab (vertex_order.hpp), by indices: a group belongs to the slab of the first of its vertices in
// memory. Clusters of about so many neighbours, which stay in a cache, follow each other, and each cluster goes by
// projection_sequence.
using SlabClusters = std::vector<std::vector<int>>;
std::vector<SlabClusters> clusters_of_slabs(const std::vector<ConstraintGroup>& groups, const VertexOrder& order,
                                            int cluster_size);

// Groups of constraints in batches: no two of a batch share a vertex, and none shares one with the batch before (with
// the two before, where that can be had), so that a kernel may load ahead and need not wait for its own stores. Keeps
// its memory from one cluster to the next; a cluster leaves no trace for the next.
class BatchScheduler {
public:
    // vertices: #V of the mesh.
    explicit BatchScheduler(int vertices)
        : last_batch_(vertices, never), waiting_(vertices), chain_at_vertex_(vertices, 0)
    {
    }

    // groups: of one kind. Returns indices into `groups`, at most batch_size a batch. Groups that share a vertex keep
    // the order given, so that the batches project to the bit what the groups project one after the other. Groups on
    // which the longest chains wait come first. Batches may be short, and empty where one must pass before a vertex may
    // be touched again. A long chain of groups, each of which shares a vertex with the next, has a batch and a pause
    // for each; projection_sequence leaves none.
    std::vector<std::vector<int>> schedule(const std::vector<ConstraintGroup>& groups);

private:
    static constexpr int never = -1000;

    std::vector<int> begin(const std::vector<ConstraintGroup>& groups);
    void take_turn(int group, std::vector<int>& freed);
    void finish(const ConstraintGroup& group, int batch, std::vector<int>& freed);
    bool rests(const ConstraintGroup& group, int since) const;

    int vertices_of_group_ = 0;
    std::vector<int> last_batch_;            // that touched each vertex
    std::vector<std::vector<int>> waiting_;  // groups at each vertex, the next one last
    // the longest chain of groups that begins with a group, or is left at a vertex
    std::vector<int> chain_of_group_, chain_at_vertex_;
    // of each group, the number of its vertices at which it is the next one
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

    std::vector<ConstraintGroup> tets_;
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
