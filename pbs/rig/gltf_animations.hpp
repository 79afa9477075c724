// The animations of a glTF file.
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs_tinygltf {
class Model;
}  // namespace pbs_tinygltf

namespace pbs {

// Appends to `rig.animations` those that move a node, and to `rig.remarks` what was left out. rig_node: the number of each of the file's
// nodes in the rig. An animation without a name gets "animation N".
void add_gltf_animations(const pbs_tinygltf::Model& model, const std::vector<int>& rig_node, Rig& rig);

}  // namespace pbs
