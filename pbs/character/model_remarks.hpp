// Warnings about a character from a rigged model that is probably wrong.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/rig/rigged_body.hpp"

#include <string>
#include <vector>

namespace pbs {

// One sentence each: an unlikely size, a surface without volume or far from the tets, bones outside the body, joints without flesh. The
// character is made of the body and has its surface and its artist's weights.
std::vector<std::string> remarks_on_model(const RiggedBody& body, const Character& character, const std::string& file);

}  // namespace pbs
