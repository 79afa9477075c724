// A rig from a glTF 2.0 file, read with tinygltf: assimp leaves out the joints of a skin that have no weight.
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs {

// The nodes of the whole file, and the meshes of its default scene (of its first one where none is default). An InputError names the field
// of the file that is wrong.
Rig read_gltf_rig(const std::string& path);

}  // namespace pbs
