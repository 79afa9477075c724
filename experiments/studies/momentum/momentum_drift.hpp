// C07: what projections do to linear and angular momentum (Eq. 3-4), on a character in a pose. The drift is the
// momentum that all corrections m dp add up to, over the sum of its norms:
//   linear   |sum m dp| / sum m |dp|        angular  |sum (p - c) x m dp| / sum |p - c| m |dp|,   c the centre of mass.
// An exact projection has zero; corrections all in one direction, or all about one axis, have 1. Single projections
// each begin from the pose, and the numerators are sums of their norms. In a pass over a class, each projection begins
// where the last one ended, and p is the position before the pass. The movement in between turns the arms of later
// corrections, so that angular momentum is conserved to first order only.
#pragma once

#include "experiments/characters/character.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

struct MomentumDrift {
    double linear = 0.0, angular = 0.0;
};

enum class ProjectedClass { stretch, volume, bind };

// The initial state is the character's LBS shape in the pose. counted: the masses of the momentum. options.masses:
// those that the projection uses. Unit masses in the options and lumped masses counted are Eq. 8-9 as printed, for m_i
// = 1, on a body of unequal masses.
MomentumDrift drift_of_projections(const pbs::Character& character, const pbs::Pose& pose,
                                   const pbs::PbsOptions& options, ProjectedClass projected, pbs::Masses counted);
MomentumDrift drift_of_a_pass(const pbs::Character& character, const pbs::Pose& pose, const pbs::PbsOptions& options,
                              ProjectedClass projected, pbs::Masses counted);

}  // namespace experiments
