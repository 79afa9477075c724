// Position based skinning of one tet mesh: Algorithm 1 with bind, stretch and volume constraints.
//   PbsSolver solver(mesh, bind_distance, jiggle_zone, options);
//   solver.advance(lbs_positions, bind_points, dt);   // every frame
//   solver.positions();
// Set-up (edges, rest lengths, rest volumes, inverse masses) is made once; the state is positions and, in the jiggling zone, velocities.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>

namespace pbs {

// Whether a mesh of this many vertices is large enough for its steps to be shared among threads. Smaller ones are worth threads over frames
// or characters.
bool shared_among_threads(int vertices);

// One mesh in motion; not copied, and for one thread at a time. Errors of input are InputErrors, breakdowns of numbers an Outcome.
class PbsSolver {
public:
    // mesh: positive rest volumes; it and the options are copied. bind_distance: d_i [m], #V, finite and not negative (unchecked).
    // jiggle_zone: #V, or empty where nothing jiggles (then no velocity exists). held: #V, or empty; a held particle has infinite mass: it
    // is where LBS puts it, and no projection moves it (the end of a cantilever; the paper holds none). InputError where options break
    // their rules (options.hpp); bind_distance, jiggle_zone or held have not one entry a vertex; a tet names a vertex that is not there or
    // has no positive rest volume; a held vertex jiggles; or any is held with LbsEntry::increment (all are integrated) or a volume_form
    // other than derived (all masses are one).
    PbsSolver(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone, const PbsOptions& options,
              const std::vector<bool>& held = {});
    ~PbsSolver();

    // One time step of dt [s]: particles outside the jiggling zone start at their LBS position [m] (#V x 3), those in it are integrated;
    // bind_points are the posed q_i [m], #V x 3. Where nothing jiggles, another start may be given in place of the LBS positions. The first
    // step puts the jiggling particles at their LBS position, at rest. InputError, before anything is moved, where lbs_positions or
    // bind_points have not #V rows, or dt_s is not positive although particles are integrated (else it is not read). That inputs are finite
    // is not checked: the outcome is then not_finite.
    StepSummary advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s);

    const Positions& positions() const;  // after the last step, in rest pose before the first [m], #V x 3

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace pbs
