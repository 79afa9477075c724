#include "experiments/deformers/blend/blend_deformer.hpp"

#include "pbs/geometry/stopwatch.hpp"

namespace experiments {

void BlendDeformer::reset(const pbs::Character& character)
{
    skinning_.emplace(character.mesh.rest, character.weights);
    positions_ = character.mesh.rest;
}

pbs::StepSummary BlendDeformer::advance(const pbs::Pose& pose, double /*dt_s*/)
{
    const pbs::Stopwatch stopwatch;
    ((*skinning_).*blend_)(pose, positions_);
    pbs::StepSummary summary;
    summary.seconds = stopwatch.seconds();
    if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

}  // namespace experiments
