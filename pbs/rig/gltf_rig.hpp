// A rig from a glTF 2.0 file (.glb, .gltf), read with tinygltf: assimp leaves out the joints of a skin that have no weight. Buffers and
// images may be read only from the folder of the file.
#pragma once

#include "pbs/rig/rig.hpp"

#include <Eigen/Core>

#include <string>

namespace pbs_tinygltf {
class Model;
}

namespace pbs {

// The nodes of the whole file, and the meshes of its default scene (of its first one where none is default). An InputError names the field
// of the file that is wrong.
Rig read_gltf_rig(const std::string& path);

RigMaterials read_gltf_materials(const std::string& path);
// The same from the bytes of a file, whose images may be below the folder of `path`.
RigMaterials gltf_materials(const std::string& bytes, const std::string& path);

// The first step of all: fills `model`; images that are files of their own are not read. An InputError where the file is no glTF 2.0,
// refers to buffers that cannot be read, or requires an extension that changes geometry and is not known here, such as
// KHR_draco_mesh_compression.
void read_gltf_model(const std::string& path, pbs_tinygltf::Model& model);
void read_gltf_model(const std::string& bytes, const std::string& path, pbs_tinygltf::Model& model);

// The numbers of an accessor, checked against the bytes that the file has, and converted as glTF 2.0, Sec. 3.6.2 defines: #elements x
// `components`. Normalised integers become numbers from -1 or 0 to 1; sparse accessors are applied. An InputError names the field of the
// file, such as "skins/0/inverseBindMatrices", where the accessor does not exist, has another number of components, reaches beyond its
// bytes or holds numbers that are not finite.
using AccessorNumbers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
AccessorNumbers accessor_numbers(const pbs_tinygltf::Model& model, int accessor, int components, const std::string& path,
                                 const std::string& field);

}  // namespace pbs
