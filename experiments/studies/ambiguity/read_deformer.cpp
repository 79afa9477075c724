#include "experiments/studies/ambiguity/read_deformer.hpp"

namespace experiments {
namespace {

std::vector<bool> zone_of(const pbs::Character& character, const Reading& reading)
{
    if (!reading.options.jiggle) return {};
    return reading.zone_mean == ZoneMean::of_bone ? pbs::jiggle_zone_by_bone(character.binding) : pbs::jiggle_zone(character.binding);
}

}  // namespace

pbs::Weights weights_of(const pbs::Character& character, const Reading& reading)
{
    return reading.blended_bones == BlendedBones::either_end ? pbs::either_end_weights(character.binding, character.skeleton)
                                                             : character.weights;
}

pbs::Positions bind_points_of(const pbs::Character& character, const Reading& reading, const pbs::Pose& pose, const pbs::Positions& lbs)
{
    return reading.bind_point == BindPoint::reprojected ? pbs::reprojected_bind_points(character.binding, character.skeleton, pose, lbs)
                                                        : pbs::posed_bind_points(character.binding, pose);
}

void ReadDeformer::reset(const pbs::Character& character)
{
    character_ = &character;
    skinning_.emplace(character.mesh.rest, weights_of(character, reading_));
    solver_ = std::make_unique<pbs::PbsSolver>(character.mesh, character.binding.distance, zone_of(character, reading_), reading_.options);
}

pbs::StepSummary ReadDeformer::advance(const pbs::Pose& pose, double dt_s)
{
    skinning_->linear(pose, lbs_);
    return solver_->advance(lbs_, bind_points_of(*character_, reading_, pose, lbs_), dt_s);
}

}  // namespace experiments
