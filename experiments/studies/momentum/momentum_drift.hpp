// C07: what projections do to linear and angular momentum (Eq. 3-4), on a character in a pose. The drift is the momentum that corrections m
// dp add up to, as a share of what they add up to without direction:
//   linear   |sum m dp| / sum m |dp|        angular  |sum (p - c) x m dp| / sum |p - c| m |dp|,   c the centre of mass.
// Zero is exact; corrections all in one direction, or all round one axis, have 1. Of single projections, each from the pose, the numerators
// are summed without direction too. Of a pass over a class, one projection after the other, p is where a particle was before: what it moves
// meanwhile turns the arms of later corrections, so that angular momentum is conserved to first order alone.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <string>
#include <vector>

namespace experiments {

struct MomentumDrift {
    double linear = 0.0, angular = 0.0;
};

enum class ProjectedClass { stretch, volume, bind };

// From the character's LBS shape in the pose. counted: the masses of the momentum; options.masses: those that the projection knows. So
// options of unit masses, counted with lumped ones, are Eq. 8-9 as printed, for m_i = 1, on a body of unequal masses.
MomentumDrift drift_of_projections(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                                   ProjectedClass projected, pbs::Masses counted);
MomentumDrift drift_of_a_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                              ProjectedClass projected, pbs::Masses counted);

}  // namespace experiments
