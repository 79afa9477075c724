// The order `ordered` as a Projection: constraints in batches of sixteen that share no vertex
// (../../packed/batch.hpp), vertices reordered for locality, slabs of the mesh in parallel
// (../../packed/vertex_order.hpp). The order of projection belongs to the mesh: any machine and any number of threads
// project alike, and threads give the same bits. It is another order than `plain`; stretch, volume and bind contradict
// each other, so the two settle on different limits (the study `timing`).
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/rows.hpp"
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/projection.hpp"

#include <vector>

namespace pbs {

// Particles in the order of memory of the batches (../../packed/vertex_order.hpp), with the dummies of each slab behind
// them, and their bind constraints, each of which moves its own vertex alone. Scalar: float or double.
template <typename Scalar>
class BatchedParticles {
public:
    // inverse_mass: #V, in the mesh's numbering; zero: held. bind: at most one per vertex, in the mesh's numbering.
    BatchedParticles(const BatchedConstraints<Scalar>& batched, const std::vector<Scalar>& inverse_mass,
                     const std::vector<BindConstraint<Scalar>>& bind);

    // p: positions, q: posed bind points [m], #V x 3; inside, positions are relative to origin [m].
    void load(const Positions& p, const Positions& q, const Vec3& origin);
    void store(const Vec3& origin, Positions& p) const;
    void project_bind_constraints(const Parallel& parallel);

    Scalar* xyzw() { return rows_.data(); }
    const Scalar* xyzw() const { return rows_.data(); }
    int vertices() const { return static_cast<int>(new_of_old_.size()); }  // #V of the mesh, dummies not counted
    // x, y, z [m], w of the vertices, then of the dummies
    const Rows<Scalar>& rows() const { return rows_; }
    // of all vertices; empty: no bind constraints
    const std::vector<BindBatch<Scalar>>& bind() const { return bind_; }

private:
    std::vector<int> new_of_old_;
    Rows<Scalar> rows_;
    std::vector<BindBatch<Scalar>> bind_;
};

// See Projection. This class reads the options threads and sleep.
template <typename Scalar>
class BatchedProjection : public Projection<Scalar> {
public:
    // tets: those of the mesh, constrained or not.
    BatchedProjection(const ConstraintSet<Scalar>& constraints, const Tets& tets, const PbsOptions& options);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override { particles_.load(p, q, origin); }
    void project_bind_constraints() override { particles_.project_bind_constraints(parallel_); }
    void project_stretch_constraints() override;
    void project_volume_constraints() override;
    void store(const Vec3& origin, Positions& p) const override { particles_.store(origin, p); }
    PositionRows<Scalar> rows() override { return {vertices(), 4, batched_.order.new_of_old}; }
    Residuals residuals() const override;

    void sleep(const SleepTolerance& tolerance) override;
    int wake(const SleepTolerance& tolerance) override;
    double sleeping_share() const override;

    double stretch_fill() const { return batched_.stretch.fill(); }  // share of lanes that have a group
    double volume_fill() const { return batched_.volume.fill(); }    // likewise

private:
    Scalar* vertices() { return particles_.xyzw(); }
    const Scalar* vertices() const { return particles_.xyzw(); }

    void project(const BatchProgram<Scalar>& program, const std::vector<std::vector<BatchRun>>& runs);
    std::vector<char> unsatisfied(const SleepTolerance& tolerance) const;  // vertices, dummies included
    void keep_awake(const std::vector<char>& vertices);                    // and all around them

    BatchedConstraints<Scalar> batched_;
    Parallel parallel_;
    std::size_t edges_, tets_;  // constraints of each class
    // In the new order. Regions are projected one after the other by the scalar code of the order plain, after all
    // batches of the tets.
    std::vector<RegionVolumeConstraint<Scalar>> regions_;
    std::vector<Scalar> inverse_mass_;  // #V
    BatchedParticles<Scalar> particles_;

    std::vector<std::vector<BatchRun>> stretch_runs_, volume_runs_;  // what is projected, of each slab
    std::vector<char> awake_;                                        // vertices, dummies included; empty: all are
    // in the last step, by more than the tolerance; they start awake
    std::vector<char> moved_;
    Rows<Scalar> loaded_;   // particles_ before the step, with sleep
    Adjacency neighbours_;  // in the new order; empty without sleep
};

// What has to pass between the core and the level of memory that holds the working set: each constraint's own data once
// per class, and the positions once in and once out. No step is faster than these bytes over the bandwidth. Loads that
// a nearer cache answers do not count.
enum class ConstraintClass { stretch, volume, bind };

// How constraints and positions lie in memory. One pose: a constraint has a vertex index of 4 bytes for each vertex,
// its rest value and its stiffness, a bind constraint d and k; a vertex is x, y, z, w. Many poses side by side share
// the constraints, which then carry inverse masses and a class of stiffness; a vertex is x, y, z for each pose. Bind
// points, x, y, z, belong to each pose.
struct ProjectionLayout {
    double scalar_bytes = 4.0;
    int poses = 1;
};

struct BodySize {
    double vertices = 0.0, edges = 0.0, tets = 0.0;

    double constraints(ConstraintClass constraint_class) const
    {
        return constraint_class == ConstraintClass::stretch  ? edges
               : constraint_class == ConstraintClass::volume ? tets
                                                             : vertices;
    }
};

// over all three classes, all poses together
double bytes_per_iteration(const ProjectionLayout& layout, const BodySize& size);
// the memory that such an iteration touches
double working_set_bytes(const ProjectionLayout& layout, const BodySize& size);

}  // namespace pbs
