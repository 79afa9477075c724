#include "experiments/run/frame_step.hpp"

#include <utility>

namespace experiments {
namespace {

int severity(pbs::Outcome outcome)
{
    return outcome == pbs::Outcome::finished ? 0 : outcome == pbs::Outcome::not_converged ? 1 : 2;
}

}  // namespace

void FrameStep::add(pbs::StepSummary summary, std::size_t step)
{
    const pbs::Outcome before = summary_.outcome;
    summary_ = std::move(summary);
    if (before == pbs::Outcome::finished || severity(summary_.outcome) > severity(before))
        worst_step_ = step;
    else
        summary_.outcome = before;
}

}  // namespace experiments
