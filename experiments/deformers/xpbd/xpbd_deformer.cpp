#include "experiments/deformers/xpbd/xpbd_deformer.hpp"

#include "pbs/geometry/stopwatch.hpp"

namespace experiments {

void XpbdDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, character.weights);
    const std::vector<bool> zone = options_.jiggle ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
    solver_ = std::make_unique<XpbdSolver>(character.mesh, character.binding.distance, zone, options_);
}

pbs::StepSummary XpbdDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    const pbs::Stopwatch stopwatch;
    skinning_->linear(pose, lbs_);
    pbs::StepSummary summary = solver_->advance(lbs_, pbs::posed_bind_points(character_->binding, pose), dt_s);
    summary.seconds = stopwatch.seconds();
    return summary;
}

}  // namespace experiments
