// The summary of one step: its residuals, the reason why it stopped, and its time.
//   const StepSummary step = solver.advance(lbs_positions, bind_points, dt_s);
//   if (step.outcome != Outcome::finished) fmt::print("{}", to_string(step.outcome));
#pragma once

#include "pbs/geometry/cost.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <cstddef>
#include <vector>

namespace pbs {

// Residuals over all constraints of a class. A class that was left out has 0.
struct Residuals {
    double stretch_rms = 0.0;  // rms of l / l0 - 1
    double volume_rms = 0.0;   // rms of V / V0 - 1
    double bind_rms_m = 0.0;   // rms of |x_i - q_i| - d_i [m]
};

// Why a step stopped. finished: all iterations were done, or the residuals are below stop_residual. not_converged:
// stop_residual is set and was not reached; the positions are valid. not_finite: a position is infinite or NaN; the
// state is lost, and a solver whose particles jiggle has to be made anew.
enum class Outcome { finished, not_finite, not_converged };
const char* to_string(Outcome outcome);  // the value's name, as records have it

// The result of PbsSolver::advance for one step.
struct StepSummary {
    int iterations = 0;                   // that were done; of the last attempt where sleepers had to be woken
    Outcome outcome = Outcome::finished;  // a breakdown is reported here, never thrown
    double sleeping_share = 0.0;          // of stretch and volume constraints that were left out
    int wakings = 0;                      // how often the step was redone because some of them were needed
    double seconds = 0.0;                 // wall time of the step
    WorkCounters work = {};               // that was done in the step, of all attempts
    std::vector<Residuals> history = {};  // one per iteration, if requested
};

// How far particles are from satisfying their constraints; summed in double. p: particle positions [m], #V; q: posed
// bind points [m], #V; sizes are not checked. A class that was left out has the residual zero.
template <typename Scalar>
Residuals residuals_of(const ConstraintSet<Scalar>& constraints, const std::vector<Vector3<Scalar>>& p,
                       const std::vector<Vector3<Scalar>>& q);

// The largest of the three residuals, with which stop_residual is compared: two are ratios, and one is in metres. NaN
// if one of them is NaN.
double largest(const Residuals& residuals);

// All steps of a deformer up to a frame, as one: the last step with the worst outcome of all. A step between two frames
// that did not converge or was not finite is thus recorded with the frame that follows it, even if the deformer has
// recovered.
//   FrameStep frame;
//   for (...) frame.add(deformer.advance(poses[step], dt_s), step);
//   record(frame.summary(), frame.worst_step());
class FrameStep {
public:
    // step: number of the step in the motion, from 0.
    void add(StepSummary summary, std::size_t step);

    const StepSummary& summary() const { return summary_; }
    // the first with the worst outcome; the last step if all finished
    std::size_t worst_step() const { return worst_step_; }

private:
    StepSummary summary_;
    std::size_t worst_step_ = 0;
};

}  // namespace pbs
