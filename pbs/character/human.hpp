// The default real character: MakeHuman's base body in Debian's assimp-testmodels, and its skeleton (data/human.skeleton.toml).
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

// In metres; available without the package. InputError in a build without PBS_WITH_RIG_IMPORT.
Skeleton human_skeleton();

void require_human();  // an InputError where it is not installed

// Mesh, skeleton, surface (if requested) and inputs; `vertices` 0: about 2,400, between Table 1's Man (1,654) and ManHQ (2,645).
// An InputError names the package where it is not installed.
Character make_human(int vertices, bool with_surface = true);

}  // namespace pbs
