// A glTF 2.0 file (.glb, .gltf) as tinygltf reads it. Buffers may be read only from the folder of the file; images are not read.
#pragma once

#include <string>

namespace pbs_tinygltf {
class Model;
}  // namespace pbs_tinygltf

namespace pbs {

// Fills `model`. An InputError where the file is no glTF 2.0, refers to buffers that cannot be read, or requires an extension that changes
// geometry and is not known here, such as KHR_draco_mesh_compression.
void read_gltf_model(const std::string& path, pbs_tinygltf::Model& model);

}  // namespace pbs
