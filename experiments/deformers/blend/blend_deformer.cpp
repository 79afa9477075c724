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

DeformerKind lbs_kind()
{
    return {.name = "lbs", .meaning = "linear blend skinning, Eq. 1", .make = [](const DeformerSpec&) -> std::unique_ptr<Deformer> {
                return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::linear);
            }};
}

DeformerKind dqs_kind()
{
    return {.name = "dqs",
            .meaning = "dual quaternion skinning (Kavan 2007), the paper's comparison",
            .make = [](const DeformerSpec&) -> std::unique_ptr<Deformer> {
                return std::make_unique<BlendDeformer>(&pbs::BlendSkinning<double>::dual_quaternion);
            }};
}

}  // namespace experiments
