// A glTF 2.0 file (.glb, .gltf) as tinygltf reads it. Buffers may be read only from the folder of the file; images are not read.
#pragma once

#include <Eigen/Core>

#include <string>

namespace pbs_tinygltf {

class Model;

}  // namespace pbs_tinygltf

namespace pbs {

// Fills `model`. An InputError where the file is no glTF 2.0, refers to buffers that cannot be read, or requires an extension that changes
// geometry and is not known here, such as KHR_draco_mesh_compression.
void read_gltf_model(const std::string& path, pbs_tinygltf::Model& model);

}  // namespace pbs

namespace pbs_tinygltf {

// The numbers of a glTF accessor, checked against the bytes that the file has, and converted as glTF 2.0, Sec. 3.6.2 defines.
class Model;

}  // namespace pbs_tinygltf

namespace pbs {

using AccessorNumbers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// #elements x `components`. Normalised integers become numbers from -1 or 0 to 1; sparse accessors are applied. An InputError names the
// field of the file, such as "skins/0/inverseBindMatrices", where the accessor does not exist, has another number of components, reaches
// beyond its bytes or holds numbers that are not finite.
AccessorNumbers accessor_numbers(const pbs_tinygltf::Model& model, int accessor, int components, const std::string& path,
                                 const std::string& field);

}  // namespace pbs
