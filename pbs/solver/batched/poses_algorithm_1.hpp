// Algorithm 1 for many poses of one mesh, in one precision. PosesSolver is the door to it.
#pragma once

#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>

namespace pbs {

// Scalar: float or double.
template <typename Scalar>
class PosesAlgorithm1 {
public:
    // See PosesSolver, which has checked the options.
    PosesAlgorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                    const std::vector<PbsOptions>& options, const std::vector<bool>& held);
    // See PosesSolver::advance.
    std::vector<StepSummary> advance(const std::vector<Positions>& lbs_positions, const std::vector<Positions>& bind_points, double dt_s);

    const Positions& positions(int pose) const { return particles_[pose].positions(); }  // [m], #V x 3

private:
    void project_block(std::size_t block, const std::vector<Positions>& bind_points);

    std::vector<PbsOptions> options_;   // of each pose
    WorkCounters work_an_iteration_;    // of a pose; constraints that any of the poses has
    std::vector<Particles> particles_;  // of each pose
    std::unique_ptr<const PoseProgram<Scalar>> program_;
    std::vector<PoseBlock<Scalar>> blocks_;  // sixteen poses each, the last maybe fewer
    Parallel parallel_;
};

}  // namespace pbs
