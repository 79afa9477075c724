// The two-bone bar as a character: the input for resetting a deformer, without files.
#pragma once

#include "pbs/character/character.hpp"
#include "tests/support/two_bone_limb.hpp"

namespace test_support {

inline pbs::Character bar_character(const std::array<int, 3>& cells)
{
    const TwoBoneLimb limb = two_bone_limb(cells, pbs::Vec3::UnitZ(), 0.0);
    pbs::Character character;
    character.name = "bar";
    character.mesh = limb.mesh;
    character.skeleton = limb.skeleton;
    character.binding = limb.binding;
    character.weights = limb.weights;
    for (int v = 0; v < limb.weights.vertices(); ++v) character.blended.push_back(limb.weights.blended(v));
    return character;
}

// The condition number of the stiffness matrix of bar_character({12, 3, 3}) with quadratic tets is below this. A test that loads the
// reference at run time cannot compute it; LinearFemDeformer.BarHasTheConditionNumberThatOthersRelyOn does.
constexpr double quadratic_bar_condition = 8e5;

}  // namespace test_support
