// Algorithm 1 of the paper for one mesh, in one precision. PbsSolver is its public interface.
// The paper leaves open where particles start. Here particles outside the jiggling zone start every step at their LBS
// position and have no velocity, and those inside are integrated (particles.hpp). Projections run in Scalar; in float,
// positions are relative to the mean position of the step.
#pragma once

#include "pbs/contact/self_contact.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/projection.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace pbs {

// One mesh in motion. Scalar: float or double.
template <typename Scalar>
class Algorithm1 {
public:
    // See PbsSolver, whose checks are made here.
    Algorithm1(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const std::vector<bool>& jiggle_zone,
               const PbsOptions& options, const std::vector<bool>& held = {});
    // See PbsSolver::advance.
    StepSummary advance(const Positions& lbs_positions, const Positions& bind_points, double dt_s);

    const Positions& positions() const { return particles_.positions(); }  // [m], #V x 3

private:
    Vec3 local_origin() const;
    std::unique_ptr<Projection<Scalar>> projection_of(ConstraintSet<Scalar> constraints, const Tets& tets);
    WorkCounters work_of(int iterations) const;
    void seek_contacts(int iteration);
    bool woken(StepSummary& summary);
    bool examine_residuals(StepSummary& summary) const;

    PbsOptions options_;
    std::int64_t bind_ = 0, stretch_ = 0, volume_ = 0;  // constraints of each class
    std::vector<Scalar> inverse_mass_;                  // #V, with contact
    std::unique_ptr<Projection<Scalar>> projection_;
    Scalar* rows_ = nullptr;  // of projection_
    std::optional<SelfContact<Scalar>> contact_;
    std::int64_t contacts_ = 0;       // projections in the step
    SleepTolerance sleep_tolerance_;  // of a mesh that the constraints have checked
    Particles particles_;
};

}  // namespace pbs
