// What looks wrong about a character from a rigged model.
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/rig/rigged_body.hpp"

#include <string>
#include <vector>

namespace pbs {

// One sentence each: an unlikely size, a surface without volume, bones outside the body, joints without flesh. `artist`: the artist's
// weights in the tets.
std::vector<std::string> remarks_on_model(const RiggedBody& body, const TetMesh& mesh, const Weights& artist, const std::string& file);

}  // namespace pbs
