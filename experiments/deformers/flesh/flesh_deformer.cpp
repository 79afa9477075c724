#include "experiments/deformers/flesh.cpp"

#include "pbs/geometry/cost.hpp"

namespace experiments {

void FleshDeformer::reset(const pbs::Character& character)
{
    flesh_.emplace(make_flesh(character));
    positions_ = character.mesh.rest;
    tets_ = character.mesh.tets.rows();
    make_solver(character, flesh_->flesh());
}

pbs::StepSummary FleshDeformer::advance(const pbs::Pose& pose, double /*dt_s*/)
{
    const pbs::Stopwatch stopwatch;
    flesh_->pose(pose);
    positions_ = flesh_->start();
    pbs::StepSummary summary = minimise(*flesh_, pose, positions_);
    summary.seconds = stopwatch.seconds();
    if (!positions_.allFinite()) summary.outcome = pbs::Outcome::not_finite;
    return summary;
}

}  // namespace experiments
