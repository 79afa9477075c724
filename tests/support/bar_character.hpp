// The two-bone limb as a character, without files: for functions that take one, and for resetting a deformer.
#pragma once

#include "experiments/characters/character.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <cmath>

namespace test_support {

inline pbs::Character character_of(const TwoBoneLimb& limb)
{
    pbs::Character character;
    character.mesh = limb.mesh;
    character.skeleton = limb.skeleton;
    character.binding = limb.binding;
    character.weights = limb.weights;
    return character;
}

inline pbs::Character bar_character(const std::array<int, 3>& cells)
{
    const TwoBoneLimb limb = two_bone_limb(cells, pbs::Vec3::UnitZ(), 0.0);
    pbs::Character character = character_of(limb);
    character.name = "bar";
    for (int v = 0; v < limb.weights.vertices(); ++v) character.blended.push_back(limb.weights.blended(v));
    return character;
}

// The condition number of the stiffness matrix of bar_character({12, 3, 3}) with quadratic tets is below this. A test
// that loads the reference at run time cannot compute it; LinearFemDeformer.BarHasTheConditionNumberThatOthersRelyOn
// does.
constexpr double quadratic_bar_condition = 8e5;

// A bar of length 2 along x that overlaps itself, wound to a helix of 8 radians, whose windings are a fifth of the
// width apart: an angle a and a - 2 pi are both on the bar for a > 2 pi - 4, so that the parts with |x| > pi / 2 - 1
// overlap. rest: vertices [m], #V x 3.
inline pbs::Positions wound(pbs::Positions rest)
{
    for (auto point : rest.rowwise()) {
        const double angle = 4.0 * point(0), radius = 0.3 + point(1);
        point << radius * std::sin(angle), radius * std::cos(angle), point(2) + 0.01 * angle;
    }
    return rest;
}

}  // namespace test_support
