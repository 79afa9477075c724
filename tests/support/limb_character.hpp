// The two-bone limb as a character, for functions that take one.
#pragma once

#include "pbs/character/character.hpp"
#include "tests/support/two_bone_limb.hpp"

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

}  // namespace test_support
