// A rig from an FBX or COLLADA file, read with assimp in its single precision.
//
// Between the keys of an FBX file the rotation of a node turns about one axis at a constant rate (slerp), whereas the format interpolates
// each Euler angle. If the angles change by a, b and c [rad] between two keys, the two differ by about (|ab| + |bc| + |ca|) / 8 rad at
// most; with one moving angle they agree. Constant and cubic curves are read as linear between their keys, which is a remark. At the keys
// the poses are those of the format.
#pragma once

#include "pbs/rig/rig.hpp"

#include <string>

struct aiScene;
namespace Assimp {
class Importer;
}

namespace pbs {

// Joints of skins are the clusters of the file that have weights. An InputError where assimp cannot read the file, or a weight is negative
// or not finite.
Rig read_assimp_rig(const std::string& path);

// As assimp writes them into a glTF file.
RigMaterials read_assimp_materials(const std::string& path);

// Its steps after check_collada_weights: assimp's reading, into a scene that the importer owns, and the conversion of that scene.
const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path);
Rig rig_of_scene(const aiScene& scene, const std::string& path);

// The skin weights of a COLLADA file as the file states them: assimp leaves out weights that are negative or not finite without a message.
//   check_collada_weights("hero.dae");
// .dae, or a .zae archive with .dae files. An InputError names the first weight, of a skin that the scene uses, that is negative or not
// finite. Text that is not XML is left to the reader.
void check_collada_weights(const std::string& path);

// How the curves of an FBX file run between their keys, which assimp does not report: it reads all of them as linear.
//   const FbxCurves curves = count_fbx_curves(read_text_file("hero.fbx"));
struct FbxCurves {
    int curves = 0;      // whose keys are marked as constant, linear or cubic
    int not_linear = 0;  // with a constant or cubic key
};

// bytes: of a binary or a text file. Damaged curves are not counted.
FbxCurves count_fbx_curves(const std::string& bytes);

}  // namespace pbs
