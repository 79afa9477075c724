// Groups of constraints in batches: no two of a batch share a vertex, and none shares one with the batch before (with the two before, where
// that can be had), so that a kernel may load ahead and need not wait for its own stores.
#pragma once

#include "pbs/solver/batched/constraint_groups.hpp"

#include <vector>

namespace pbs {

// Remembers from one kind to the next which batch touched a vertex last.
class BatchScheduler {
public:
    // vertices: #V of the mesh.
    explicit BatchScheduler(int vertices) : uses_(vertices, 0), last_batch_(vertices, never) {}

    // groups: of one kind. Returns indices into `groups`, at most batch_size a batch, in the order given; of the last quarter the groups at
    // the busiest vertices first. (To rank all of them fills a tenth more lanes and leaves two or three times plain's difference in
    // volume.) Batches may be short, and empty where one must pass before a vertex may be touched again.
    std::vector<std::vector<int>> schedule(const std::vector<ConstraintGroup>& groups);

private:
    static constexpr int never = -1000;

    void rank_by_use(const std::vector<ConstraintGroup>& groups, std::vector<int>& left);
    bool touched_since(const ConstraintGroup& group, int batch) const;
    void touch(const ConstraintGroup& group, int batch);

    int vertices_of_group_ = 0;
    std::vector<int> rank_;
    std::vector<int> uses_;        // groups that are left at each vertex
    std::vector<int> last_batch_;  // that touched each vertex
};

}  // namespace pbs
