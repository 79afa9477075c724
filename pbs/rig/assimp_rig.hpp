// A rig from an FBX or COLLADA file, read with assimp in its single precision.
#pragma once

#include "pbs/rig/rig.hpp"

struct aiScene;
namespace Assimp {
class Importer;
}

namespace pbs {

// Joints of skins are the clusters of the file that have weights. An InputError where assimp cannot read the file, or a weight is negative
// or not finite.
Rig read_assimp_rig(const std::string& path);

// Its two steps: assimp's reading, into a scene that the importer owns, and the conversion of that scene.
const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path);
Rig rig_of_scene(const aiScene& scene, const std::string& path);

}  // namespace pbs
