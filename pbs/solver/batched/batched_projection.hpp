// Orders `ordered` and `grouped` as a Projection: constraints in batches of sixteen that share no vertex (../../packed/batch.hpp), vertices reordered
// for locality, slabs of the mesh in parallel (../../packed/vertex_order.hpp). The order of projection belongs to the mesh: any machine and any number
// of threads project alike, and threads give the same bits. It is another order than `plain`; stretch, volume and bind contradict each
// other, so the two settle on different limits (the study `equal_quality`).
#pragma once

#include "pbs/geometry/topology.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/projection.hpp"

#include <vector>

namespace pbs {

// See Projection. This class reads the options order, threads and sleep.
template <typename Scalar>
class BatchedProjection : public Projection<Scalar> {
public:
    // tets: those whose edges may be grouped, constrained or not.
    BatchedProjection(const ConstraintSet<Scalar>& constraints, const Tets& tets, const PbsOptions& options);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override;
    void project_bind_constraints() override;
    void project_stretch_constraints() override;
    void project_volume_constraints() override;
    void store(const Vec3& origin, Positions& p) const override;
    Residuals residuals() const override;

    void sleep(const SleepTolerance& tolerance) override;
    int wake(const SleepTolerance& tolerance) override;
    double sleeping_share() const override;

    std::size_t bytes_an_iteration() const;                          // constraint data once, positions read and written in each class
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
    // In the new order. Regions are projected one after the other by the scalar code of the order plain, after all batches of the tets.
    std::vector<RegionVolumeConstraint<Scalar>> regions_;
    std::vector<Scalar> inverse_mass_;  // #V
    BatchedParticles<Scalar> particles_;

    std::vector<std::vector<BatchRun>> stretch_runs_, volume_runs_;  // what is projected, of each slab
    std::vector<char> awake_;                                        // vertices, dummies included; empty: all are
    std::vector<char> moved_;                                        // in the last step, by more than the tolerance; they start awake
    std::vector<typename BatchedParticles<Scalar>::Block> loaded_;   // particles_ before the step, with sleep
    Adjacency neighbours_;                                           // in the new order; empty without sleep
};

}  // namespace pbs
