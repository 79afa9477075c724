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

}  // namespace test_support
