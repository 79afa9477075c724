// A rig from an FBX or COLLADA file, read with assimp in its single precision.
//
// Between the keys of an FBX file the rotation of a node turns about one axis at a constant rate (slerp), whereas the format interpolates
// each Euler angle. If the angles change by a, b and c [rad] between two keys, the two differ by about (|ab| + |bc| + |ca|) / 8 rad at
// most; with one moving angle they agree. Constant and cubic curves are read as linear between their keys, which is a remark. At the keys
// the poses are those of the format.
#pragma once

#include "pbs/rig/rig.hpp"

struct aiScene;
namespace Assimp {
class Importer;
}  // namespace Assimp

namespace pbs {

// Joints of skins are the clusters of the file that have weights. An InputError where assimp cannot read the file, or a weight is negative
// or not finite.
Rig read_assimp_rig(const std::string& path);

// Its steps after check_collada_weights: assimp's reading, into a scene that the importer owns, and the conversion of that scene.
const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path);
Rig rig_of_scene(const aiScene& scene, const std::string& path);

}  // namespace pbs
