// A deformer's steps up to a frame, as one: the last of them, with the worst outcome of all. A step between two frames that was not
// reached, or not finite and found back from, is on record with the frame that follows it.
//   FrameStep frame;  for (...) frame.add(deformer.advance(poses[step], dt_s), step);  record(frame.summary(), frame.worst_step());
#pragma once

#include "pbs/solver/step_summary.hpp"

#include <cstddef>

namespace experiments {

class FrameStep {
public:
    // step: counted from the motion's first, 0.
    void add(pbs::StepSummary summary, std::size_t step);

    const pbs::StepSummary& summary() const { return summary_; }
    std::size_t worst_step() const { return worst_step_; }  // the first with that outcome; where all finished, the last

private:
    pbs::StepSummary summary_;
    std::size_t worst_step_ = 0;
};

}  // namespace experiments
