// Position based skinning of one tet mesh: Algorithm 1 with bind, stretch and volume constraints.
//   PbsSolver solver(mesh, bind_distance, jiggle_zone, options);
//   solver.advance(lbs_positions, bind_points, dt);   // every frame
//   solver.positions();
// Set-up (edges, rest lengths, rest volumes, inverse masses) is made once; the state is positions and, in the jiggling
// zone, velocities.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <vector>

namespace pbs {

// Whether a mesh of this many vertices is large enough for its steps to be shared among threads. Smaller ones are worth
// threads over frames or characters.
bool shared_among_threads(int vertices);

// One mesh in motion; not copied, and for one thread at a time. Errors of input are InputErrors, breakdowns of numbers
// an Outcome.
class PbsSolver {
public:
    // mesh: positive rest volumes; it and the options are copied. bind_distance: d_i [m], #V, finite and not negative
    // (unchecked). jiggle_zone: #V, or empty where nothing jiggles (then no velocity exists). held: #V, or empty; a
    // held particle has infinite mass: it is where LBS puts it, and no projection moves it (the end of a cantilever;
    // the paper holds none). InputError where options break their rules (options.hpp); bind_distance, jiggle_zone or
    // held have not one entry per vertex; a tet names a vertex that is not there or has no positive rest volume; a held
    // vertex jiggles; or any is held with LbsEntry::increment (all are integrated) or a volume_form other than derived
    // (all masses are one).
    PbsSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
              const PbsOptions& options, const std::vector<bool>& held = {});
    ~PbsSolver();

    // One time step of dt [s]: particles outside the jiggling zone start at their LBS position [m] (#V x 3), those in
    // it are integrated; bind_points are the posed q_i [m], #V x 3. Where nothing jiggles, another start may be given
    // in place of the LBS positions. The first step puts the jiggling particles at their LBS position, at rest.
    // InputError, before anything is moved, where lbs_positions or bind_points have not #V rows, or dt_s is not
    // positive although particles are integrated (else it is not read). That inputs are finite is not checked: the
    // outcome is then not_finite.
    StepSummary advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s);

    const Positions& positions() const;  // after the last step, in rest pose before the first [m], #V x 3

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// Algorithm 1 for many poses of one mesh side by side: frames, parameter sets or characters that share their tets. Each
// of sixteen lanes is a pose, so nothing is gathered and a pose costs a third to a half of what it costs alone.
//   PosesSolver solver(mesh, bind_distance, jiggle_zone, options);   // options: of every pose
//   solver.advance(lbs_positions, bind_points, dt);                  // of every pose
//   solver.positions(7);
// Poses may differ in iterations, stiffnesses and gravity; order (ordered), precision and masses are those of
// the first, and each is projected in the order that PbsSolver would take. A residual to stop at, records of iterations
// and sleep are not for many poses at once.
inline constexpr int poses_at_once = 16;  // that share a block; a last block may have fewer

// Many poses, each with a state of its own; not copied, and for one thread at a time.
class PosesSolver {
public:
    // As PbsSolver; options: one per pose; threads of the first are shared out over blocks of sixteen poses. InputError
    // as there, and where there is no pose, poses differ in order, precision, masses or whether they jiggle, or ask for
    // what is not for many at once: order plain, another reading than Algorithm 1's (volume_form, class_order,
    // lbs_entry, bind_on_bone, Jiggle::k_bind), a change to the paper's constraints (bind_to, volume_of,
    // k_stretch_length_m), contact, stop_residual, record_iterations, sleep.
    PosesSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
                const std::vector<PbsOptions>& options, const std::vector<bool>& held = {});
    ~PosesSolver();

    // One time step of dt [s]. lbs_positions, bind_points: of every pose [m], #V x 3; the same for all where there is
    // one only. There is one summary per pose; seconds is an even share of the step's wall time. InputError where there
    // are neither as many positions as poses nor one, and as PbsSolver::advance.
    std::vector<StepSummary> advance(const std::vector<Positions>& lbs_positions,
                                     const std::vector<Positions>& bind_points, double dt_s);

    const Positions& positions(int pose) const;  // pose: from 0, unchecked [m], #V x 3

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace pbs
