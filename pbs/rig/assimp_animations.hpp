// The animations of a file that assimp has read.
#pragma once

#include "pbs/rig/rig.hpp"

struct aiScene;

namespace pbs {

// Appends to `rig.animations` those that move a node of the rig; channels of other names are remarks. The matrix of a node that is moved is
// removed, since an animation replaces its translation, rotation and scale.
void add_assimp_animations(const aiScene& scene, Rig& rig);

}  // namespace pbs
