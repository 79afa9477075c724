// The constraints of one class as batches in memory, in the order the kernels work them off: slab by slab, within a slab cluster by
// cluster, within a cluster kind by kind. A cluster is what stays in the nearest cache.
#pragma once

#include "pbs/solver/batched/constraint_groups.hpp"
#include "pbs/solver/batched/vertex_order.hpp"

#include <vector>

namespace pbs {

// Batches of one kind that follow each other.
struct BatchRun {
    GroupKind kind;
    int count = 0;
    std::size_t first_line = 0;  // where they begin in the program's memory
};

// What a constraint is told, by its place in its class.
template <typename Scalar>
struct ConstraintValues {
    std::vector<Scalar> rest, stiffness;  // as Batch has them
};

template <typename Scalar>
class BatchProgram {
public:
    BatchProgram() = default;
    // Vertices of groups are those of the mesh. dummy_begin: first of the dummy vertices that lanes without a group work on,
    // dummies_a_slab for each slab.
    BatchProgram(const std::vector<ConstraintGroup>& groups, const ConstraintValues<Scalar>& values, const VertexOrder& order,
                 int dummy_begin);

    static constexpr int dummies_a_slab = batch_size * largest_group;

    const std::vector<BatchRun>& runs(int slab) const { return runs_[slab]; }
    const void* batches(const BatchRun& run) const { return lines_.data() + run.first_line; }
    std::size_t bytes() const { return lines_.size() * sizeof(CacheLine); }
    double fill() const;  // share of lanes that have a group

private:
    struct alignas(64) CacheLine {
        std::byte bytes[64];
    };
    template <GroupKind kind>
    void append(const std::vector<ConstraintGroup>& groups, const std::vector<std::vector<int>>& batches,
                const ConstraintValues<Scalar>& values, const VertexOrder& order, int slab, int dummy);

    std::vector<CacheLine> lines_;
    std::vector<std::vector<BatchRun>> runs_;  // of each slab
    std::size_t groups_ = 0, lanes_ = 0;
};

}  // namespace pbs
