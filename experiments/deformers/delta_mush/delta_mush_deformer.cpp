#include "experiments/deformers/delta_mush/delta_mush_deformer.hpp"

#include "pbs/geometry/stopwatch.hpp"

namespace experiments {

void DeltaMushDeformer::reset(const pbs::Character& character)
{
    skinning_.emplace(character.mesh.rest, character.weights);
    mush_.emplace(character.mesh, options_);
    positions_ = character.mesh.rest;
}

pbs::StepSummary DeltaMushDeformer::advance(const pbs::Pose& pose, double /*dt_s*/)
{
    const pbs::Stopwatch stopwatch;
    skinning_->linear(pose, lbs_);
    mush_->apply(lbs_, positions_);
    pbs::StepSummary summary;
    summary.seconds = stopwatch.seconds();
    if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

}  // namespace experiments
