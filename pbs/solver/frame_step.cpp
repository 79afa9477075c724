#include "pbs/solver/step_summary.hpp"

#include <utility>

namespace pbs {
namespace {

int severity(Outcome outcome)
{
    return outcome == Outcome::finished ? 0 : outcome == Outcome::not_converged ? 1 : 2;
}

}  // namespace

void FrameStep::add(StepSummary summary, std::size_t step)
{
    const Outcome before = summary_.outcome;
    summary_ = std::move(summary);
    if (before == Outcome::finished || severity(summary_.outcome) > severity(before))
        worst_step_ = step;
    else
        summary_.outcome = before;
}

}  // namespace pbs
