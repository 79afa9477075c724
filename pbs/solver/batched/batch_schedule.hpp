// Groups of constraints in batches: no two of a batch share a vertex, and none shares one with the batch before (with the two before, where
// that can be had), so that a kernel may load ahead and need not wait for its own stores.
#pragma once

#include "pbs/packed/groups.hpp"

#include <vector>

namespace pbs {

// Keeps its memory from one cluster to the next; a cluster leaves no trace for the next.
class BatchScheduler {
public:
    // vertices: #V of the mesh.
    explicit BatchScheduler(int vertices) : last_batch_(vertices, never), waiting_(vertices), chain_at_vertex_(vertices, 0) {}

    // groups: of one kind. Returns indices into `groups`, at most batch_size a batch. Groups that share a vertex keep the order given, so
    // that the batches project to the bit what the groups project one after the other. Groups on which the longest chains wait come first.
    // Batches may be short, and empty where one must pass before a vertex may be touched again. A long chain of groups, each of which
    // shares a vertex with the next, has a batch and a pause for each; projection_sequence leaves none.
    std::vector<std::vector<int>> schedule(const std::vector<ConstraintGroup>& groups);

private:
    static constexpr int never = -1000;

    std::vector<int> begin(const std::vector<ConstraintGroup>& groups);
    void take_turn(int group, std::vector<int>& freed);
    void finish(const ConstraintGroup& group, int batch, std::vector<int>& freed);
    bool rests(const ConstraintGroup& group, int since) const;

    int vertices_of_group_ = 0;
    std::vector<int> last_batch_;                        // that touched each vertex
    std::vector<std::vector<int>> waiting_;              // groups at each vertex, the next one last
    std::vector<int> chain_of_group_, chain_at_vertex_;  // the longest chain of groups that begins with a group, or is left at a vertex
    std::vector<int> turns_;                             // of each group, the number of its vertices at which it is the next one
};

}  // namespace pbs
