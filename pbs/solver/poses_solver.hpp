// Algorithm 1 for many poses of one mesh side by side: frames, parameter sets or characters that share their tets. Each of sixteen lanes is
// a pose, so nothing is gathered and a pose costs a third to a half of what it costs alone.
//   PosesSolver solver(mesh, bind_distance, jiggle_zone, options);   // options: of every pose
//   solver.advance(lbs_positions, bind_points, dt);                  // of every pose
//   solver.positions(7);
// Poses may differ in iterations, stiffnesses and gravity; order (ordered, grouped), precision and masses are those of the first, and each
// is projected in the order that PbsSolver would take. A residual to stop at, records of iterations and sleep are not for many poses at
// once.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <vector>

namespace pbs {

inline constexpr int poses_at_once = 16;  // that share a block; a last block may have fewer

// Many poses, each with a state of its own; not copied, and for one thread at a time.
class PosesSolver {
public:
    // As PbsSolver; options: one per pose; threads of the first are shared out over blocks of sixteen poses. InputError as there, and
    // where there is no pose, poses differ in order, precision, masses or whether they jiggle, or ask for what is not for many at once:
    // order plain, another reading than Algorithm 1's (volume_form, class_order, lbs_entry, bind_on_bone, Jiggle::k_bind), a change to
    // the paper's constraints (bind_to, volume_of, k_stretch_length_m), stop_residual, record_iterations, sleep.
    PosesSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                const std::vector<PbsOptions>& options, const std::vector<bool>& held = {});
    ~PosesSolver();

    // One time step of dt [s]. lbs_positions, bind_points: of every pose [m], #V x 3; the same for all where there is one only.
    // There is one summary per pose; seconds is an even share of the step's wall time. InputError where there are neither as many positions
    // as poses nor one, and as PbsSolver::advance.
    std::vector<StepSummary> advance(const std::vector<Positions>& lbs_positions, const std::vector<Positions>& bind_points, double dt_s);

    const Positions& positions(int pose) const;  // pose: from 0, unchecked [m], #V x 3

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace pbs
