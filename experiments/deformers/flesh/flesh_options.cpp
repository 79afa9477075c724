#include "experiments/deformers/flesh/flesh_options.hpp"

#include "experiments/process/blas_kernels.hpp"

#include <utility>

namespace experiments {
namespace {

// CHOLMOD is linked with BLAS, whose kernels have to be selected before the first module that brings it.
pbs::HeldFlesh held_flesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options)
{
    select_blas_kernels();
    return {character.mesh, pbs::smooth_springs(character, springs).springs, static_cast<int>(character.skeleton.bones.size()), options};
}

}  // namespace

PosedFlesh::PosedFlesh(const pbs::Character& character, const pbs::SmoothSpringOptions& springs, const pbs::HeldFleshOptions& options,
                       pbs::FleshStart start)
    : flesh_(held_flesh(character, springs, options)),
      how_(start),
      skinning_(character.mesh.rest, start == pbs::FleshStart::smooth_dqs ? flesh_.smooth_weights(character.weights) : character.weights)
{
}

void PosedFlesh::pose(const pbs::Pose& pose)
{
    flesh_.hold().centres(pose, centres_);
    if (next_start_)
        start_ = *std::exchange(next_start_, {});
    else if (how_ == pbs::FleshStart::smooth_dqs)
        skinning_.dual_quaternion(pose, start_);
    else
        skinning_.linear(pose, start_);
}

nlohmann::json PosedFlesh::record() const
{
    return {{"springs_outside_the_tets", flesh_.hold().left_out()}, {"entries_of_factor", flesh_.factor().value.size()}};
}

}  // namespace experiments
