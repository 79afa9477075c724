// All steps of a deformer up to a frame, as one: the last step with the worst outcome of all. A step between two frames that did not
// converge or was not finite is thus recorded with the frame that follows it, even if the deformer has recovered.
//   FrameStep frame;  for (...) frame.add(deformer.advance(poses[step], dt_s), step);  record(frame.summary(), frame.worst_step());
#pragma once

#include "pbs/solver/step_summary.hpp"

#include <cstddef>

namespace pbs {

class FrameStep {
public:
    // step: number of the step in the motion, from 0.
    void add(StepSummary summary, std::size_t step);

    const StepSummary& summary() const { return summary_; }
    std::size_t worst_step() const { return worst_step_; }  // the first with the worst outcome; the last step if all finished

private:
    StepSummary summary_;
    std::size_t worst_step_ = 0;
};

}  // namespace pbs
