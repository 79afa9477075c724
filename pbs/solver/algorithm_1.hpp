// Algorithm 1 of the paper for one mesh, in one precision. PbsSolver is the door to it.
// Where Algorithm 1 is ambiguous: particles outside the jiggling zone start every step at their LBS position and have no velocity; those
// inside are integrated. Positions and velocities are kept in double; projections run in Scalar, in float relative to a local origin (the
// mean LBS position of the step), so that a character far from the world's origin loses no digits.
#pragma once

#include "pbs/solver/projection.hpp"
#include "pbs/solver/step_summary.hpp"

namespace pbs {

template <typename Scalar>
class Algorithm1 {
public:
    // See PbsSolver.
    Algorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone, const PbsOptions& options,
               const std::vector<bool>& held = {});
    StepSummary advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s);

    const Positions& positions() const { return x_; }  // [m], #V x 3

private:
    void check_input(const Positions& lbs_positions, const Positions& bind_points, double dt_s) const;
    Vec3 local_origin() const;
    bool examine_residuals(StepSummary& summary) const;

    PbsOptions options_;
    std::unique_ptr<Projection<Scalar>> projection_;
    std::vector<int> jiggling_;  // vertices that are integrated

    Positions x_;  // x_i [m], #V x 3
    Positions v_;  // v_i [m/s] of the jiggling vertices, #jiggling x 3
    Positions p_;  // p_i [m], #V x 3
};

}  // namespace pbs
