// The orders `ordered` and `grouped` of XPBD: the batches, the slabs and the sequence of BatchedProjection, with a compliance and a
// multiplier for each constraint. Any machine and any number of threads project alike, and threads give the same bits.
#pragma once

#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batch_program.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <vector>

namespace pbs {

// The stretch and volume constraints as batches, whose stiffness is 1 / alpha: of an edge [N/m], and of six times the volume of a tet
// [N/m^5]. order: ordered or grouped.
template <typename Scalar>
BatchedConstraints<Scalar> make_batched_constraints(const XpbdConstraints& constraints, const Tets& tets, Order order);

// See XpbdProjection. Scalar: float or double.
template <typename Scalar>
class BatchedXpbdProjection : public XpbdProjection {
public:
    BatchedXpbdProjection(const XpbdConstraints& constraints, const Tets& tets, Order order, int threads);

    void load(const Positions& p, const Positions& q, const Vec3& origin) override;
    void begin_substep(double dt_s) override;
    void forget_multipliers() override;
    void project_bind_constraints() override;  // compliance zero: their multipliers change nothing and are not kept
    void project_stretch_constraints() override;
    void project_volume_constraints() override;
    void store(const Vec3& origin, Positions& p) const override;

private:
    struct alignas(64) Lambdas {  // of one constraint of each group of a batch
        Scalar of_lane[batch_size];
    };
    struct Multipliers {
        std::vector<Lambdas> lambdas;                        // by runs, then batches, then constraints
        std::vector<std::vector<std::size_t>> first_of_run;  // of each slab
    };

    static Multipliers multipliers_of(const BatchProgram<Scalar>& program);
    void project(const BatchProgram<Scalar>& program, Multipliers& multipliers);

    BatchedConstraints<Scalar> batched_;
    Parallel parallel_;
    BatchedParticles<Scalar> particles_;
    Multipliers stretch_, volume_;
    Scalar dt2_ = Scalar(0);  // the square of the substep [s^2]
};

}  // namespace pbs
