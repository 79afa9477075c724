// Rigs by format, and their materials: glTF 2.0 (.glb, .gltf) with tinygltf, since assimp leaves out the joints of a
// skin that have no weight; FBX by a reader of its own, since no library applies all of its rules; COLLADA with assimp
// in its single precision. Buffers and images may be read only from the folder of the file.
#pragma once

#include "experiments/rigs/rig.hpp"

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

// The nodes of the whole file, and the meshes of its default scene (of its first one where none is default). An
// InputError names the field of the file that is wrong.
Rig read_gltf_rig(const std::string& path);

RigMaterials read_gltf_materials(const std::string& path);
// The same from the bytes of a file, whose images may be below the folder of `path`.
RigMaterials gltf_materials(const std::string& bytes, const std::string& path);

// The first step of all: fills `model`; images that are files of their own are not read. An InputError where the file
// is no glTF 2.0, refers to buffers that cannot be read, or requires an extension that is not known here and that
// nodes, meshes, animations or buffers have, such as KHR_draco_mesh_compression.
void read_gltf_model(const std::string& bytes, const std::string& path, pbs_tinygltf::Model& model);

// The numbers of an accessor, checked against the bytes that the file has, and converted as glTF 2.0, Sec. 3.6.2
// defines: #elements x `components`. Normalised integers become numbers from -1 or 0 to 1; sparse accessors are
// applied. An InputError names the field of the file, such as "skins/0/inverseBindMatrices", where the accessor does
// not exist, has another number of components, reaches beyond its bytes or holds numbers that are not finite;
// accessor_values accepts these.
using AccessorNumbers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
AccessorNumbers accessor_values(const pbs_tinygltf::Model& model, int accessor, int components, const std::string& path,
                                const std::string& field);
AccessorNumbers accessor_numbers(const pbs_tinygltf::Model& model, int accessor, int components,
                                 const std::string& path, const std::string& field);

// FBX 7.0 and later, from the objects of the file and by the format's formulas (fbx_transform.hpp), in double
// precision. Joints of skins are the clusters of the file that have points. An InputError names the object that is
// wrong.
Rig read_fbx_rig(const std::string& path);

// The names of the materials, in the order of RigLook::material.
std::vector<std::string> fbx_material_names(const std::string& path);

// Joints of skins are those of the file that have weights. An InputError where assimp cannot read the file, and those
// of collada_document.hpp.
Rig read_collada_rig(const std::string& path);

// Of FBX and COLLADA files, as assimp writes them into a glTF file.
RigMaterials read_assimp_materials(const std::string& path);

// The steps of read_collada_rig after collada_document.hpp: assimp's reading, of a text in place of the file's if one
// is given, into a scene that the importer owns, and the conversion of that scene.
const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path, const std::string& text = "");
Rig rig_of_scene(const aiScene& scene, const std::string& path);

// On coordinates in single precision so far from the origin that their rounding shows in a volume: the surface is
// smaller than 1e5 steps between two floats there. Empty otherwise, and where a coordinate has more digits than a
// float. points: #P x 3, in any unit.
std::string remark_on_single_precision(const Positions& points, const Triangles& triangles);

}  // namespace pbs
