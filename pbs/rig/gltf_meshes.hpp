// The meshes of a glTF file, with their skins.
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs_tinygltf {
class Model;
}  // namespace pbs_tinygltf

namespace pbs {

// The mesh of node `gltf_node` of the file with all its primitives of triangles. rig_node: the number of each of the file's nodes in the
// rig. Appends to `rig.meshes`, and to `rig.remarks` what was left out: points, lines, morph targets.
void add_gltf_mesh(const pbs_tinygltf::Model& model, int gltf_node, const std::vector<int>& rig_node, Rig& rig);

}  // namespace pbs
