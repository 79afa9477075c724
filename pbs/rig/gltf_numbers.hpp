// The numbers of a glTF accessor, checked against the bytes that the file has, and converted as glTF 2.0, Sec. 3.6.2 defines.
#pragma once

#include <Eigen/Core>

#include <string>

namespace pbs_tinygltf {
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
