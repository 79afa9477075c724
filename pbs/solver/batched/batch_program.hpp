// The constraints of one class as batches in memory, in the order the kernels work them off: slab by slab, within a
// slab cluster by cluster. A cluster is what stays in the nearest cache.
#pragma once

#include "pbs/packed/constraint_sequence.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <vector>

namespace pbs {

// Batches of one kind that follow each other.
struct BatchRun {
    ConstraintKind kind;         // which Batch they are
    int count = 0;               // of batches
    std::size_t first_line = 0;  // where they begin in the program's memory
};

// Data of a constraint, indexed by its position in its class.
template <typename Scalar>
struct ConstraintValues {
    std::vector<Scalar> rest, stiffness;  // as Batch has them, one per constraint
};

// Made once a mesh. Scalar: float or double.
template <typename Scalar>
class BatchProgram {
public:
    BatchProgram() = default;
    // Vertices of constraints are those of the mesh. dummy_begin: first of the dummy vertices that lanes without a
    // constraint work on, dummies_a_slab for each slab.
    BatchProgram(const std::vector<PackedConstraint>& constraints, const ConstraintValues<Scalar>& values,
                 const VertexOrder& order, int dummy_begin);

    static constexpr int dummies_a_slab = batch_size * 4;  // so that a whole batch of them shares none

    const std::vector<BatchRun>& runs(int slab) const { return runs_[slab]; }  // all of a slab
    // Batch<Scalar, run.kind>, run.count of them
    const void* batches(const BatchRun& run) const { return lines_.data() + run.first_line; }
    int slabs() const { return static_cast<int>(runs_.size()); }           // of the mesh
    int batches() const { return static_cast<int>(lanes_ / batch_size); }  // of all slabs

    // f(vertices in the new order, rest, stiffness) of every constraint in the order of projection: even slabs, then
    // odd ones. Sixteen in a row share no vertex.
    template <typename F>
    void for_each_constraint(F&& f) const;

    // The part of a slab whose constraints have an awake vertex; awake: one entry per vertex in the new order,
    // including dummies.
    std::vector<BatchRun> runs_awake(int slab, const std::vector<char>& awake) const;
    // Sets the flag of every vertex of a constraint whose residual at these positions exceeds the tolerance or is not a
    // number.
    void mark_unsatisfied(const Scalar* vertices, double tolerance, std::vector<char>& marked) const;

    double fill() const;  // share of lanes that have a constraint

private:
    struct alignas(64) CacheLine {
        std::byte bytes[64];
    };
    template <ConstraintKind kind>
    void append(const std::vector<PackedConstraint>& constraints, const std::vector<std::vector<int>>& batches,
                const ConstraintValues<Scalar>& values, const VertexOrder& order, int slab, int dummy);

    std::vector<CacheLine> lines_;
    std::vector<std::vector<BatchRun>> runs_;  // of each slab
    std::size_t constraints_ = 0, lanes_ = 0;
};

template <typename Scalar>
template <typename F>
void BatchProgram<Scalar>::for_each_constraint(F&& f) const
{
    const auto of_run = [&](auto kind, const BatchRun& run) {
        const auto* all = static_cast<const Batch<Scalar, kind()>*>(batches(run));
        for (int b = 0; b < run.count; ++b)
            for (int lane = 0; lane < batch_size; ++lane) {
                if (all[b].stiffness[lane] == Scalar(0)) continue;
                std::array<int, corners(kind())> vertex;
                for (std::size_t v = 0; v < vertex.size(); ++v)
                    vertex[v] = static_cast<int>(all[b].offset[v][lane] / 4);
                f(vertex, all[b].rest[lane], all[b].stiffness[lane]);
            }
    };
    for (const int parity : {0, 1})
        for (int slab = parity; slab < slabs(); slab += 2)
            for (const BatchRun& run : runs_[slab]) with_kind(run.kind, [&](auto kind) { of_run(kind, run); });
}

// A constraint set in the order `ordered`: where vertices lie, and stretch and volume constraints as
// batches. Scalar: float or double.
template <typename Scalar>
struct BatchedConstraints {
    VertexOrder order;    // where the mesh's vertices lie
    int dummy_begin = 0;  // dummy vertices follow the mesh's, from a whole batch on; see BatchProgram
    // Programs of the edges and the tets; empty where the class is left out.
    BatchProgram<Scalar> stretch, volume;

    int vertices() const { return static_cast<int>(order.old_of_new.size()); }  // #V of the mesh, dummies not counted
};

// The vertices of the constraints of a class and, as Batch has them, their values.
template <typename Scalar, std::size_t vertices>
struct ConstraintClassData : ConstraintValues<Scalar> {
    void add(const std::array<int, vertices>& indices, Scalar rest, Scalar stiffness)
    {
        vertex.push_back(indices);
        this->rest.push_back(rest);
        this->stiffness.push_back(stiffness);
    }
    std::vector<std::array<int, vertices>> vertex;
};

// vertices: #V of the mesh. tets: those by which its vertices are ordered, constrained or not.
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintClassData<Scalar, 2>& stretch,
                                                    const ConstraintClassData<Scalar, 4>& volume, int vertices,
                                                    const Tets& tets);
// Batches the stretch and volume constraints of Algorithm 1.
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const ConstraintSet<Scalar>& constraints, const Tets& tets);

// Batches those of XPBD, whose stiffness is 1 / alpha here: of an edge [N/m], and of six times the volume of a tet
// [N/m^5].
struct XpbdConstraints;
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const XpbdConstraints& constraints, const Tets& tets);

}  // namespace pbs
