// A rig from an FBX or COLLADA file, read with assimp in its single precision.
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs {

// Joints of skins are the clusters of the file that have weights. An InputError where assimp cannot read the file.
Rig read_assimp_rig(const std::string& path);

}  // namespace pbs
