// Rigs by format, and their materials: glTF 2.0 (.glb, .gltf) with tinygltf, since assimp leaves out the joints of a skin that have no
// weight; FBX and COLLADA with assimp in its single precision. Buffers and images may be read only from the folder of the file.
#pragma once

#include "pbs/rig/rig.hpp"

#include <Eigen/Core>

#include <string>

namespace pbs_tinygltf {
class Model;
}
struct aiScene;
namespace Assimp {
class Importer;
}

namespace pbs {

// The nodes of the whole file, and the meshes of its default scene (of its first one where none is default). An InputError names the field
// of the file that is wrong.
Rig read_gltf_rig(const std::string& path);

RigMaterials read_gltf_materials(const std::string& path);
// The same from the bytes of a file, whose images may be below the folder of `path`.
RigMaterials gltf_materials(const std::string& bytes, const std::string& path);

// The first step of all: fills `model`; images that are files of their own are not read. An InputError where the file is no glTF 2.0,
// refers to buffers that cannot be read, or requires an extension that is not known here and that nodes, meshes, animations or buffers
// have, such as KHR_draco_mesh_compression.
void read_gltf_model(const std::string& bytes, const std::string& path, pbs_tinygltf::Model& model);

// The numbers of an accessor, checked against the bytes that the file has, and converted as glTF 2.0, Sec. 3.6.2 defines: #elements x
// `components`. Normalised integers become numbers from -1 or 0 to 1; sparse accessors are applied. An InputError names the field of the
// file, such as "skins/0/inverseBindMatrices", where the accessor does not exist, has another number of components, reaches beyond its
// bytes or holds numbers that are not finite; accessor_values accepts these.
using AccessorNumbers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
AccessorNumbers accessor_values(const pbs_tinygltf::Model& model, int accessor, int components, const std::string& path,
                                const std::string& field);
AccessorNumbers accessor_numbers(const pbs_tinygltf::Model& model, int accessor, int components, const std::string& path,
                                 const std::string& field);

// Joints of skins are the clusters of the file that have weights. An InputError where assimp cannot read the file, or a weight is negative
// or not finite.
// Between the keys of an FBX file the rotation of a node turns about one axis at a constant rate (slerp), whereas the format interpolates
// each Euler angle. If the angles change by a, b and c [rad] between two keys, the two differ by about (|ab| + |bc| + |ca|) / 8 rad at
// most; with one moving angle they agree. Constant and cubic curves are read as linear between their keys, which is a remark. At the keys
// the poses are those of the format.
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
