// Rigs from files: glTF 2.0 (.glb, .gltf) by tinygltf, FBX and COLLADA (.dae, .zae) by assimp, each in a process of its own.
//   const Rig rig = read_rig("hero.glb");
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs {

// Does the file's content look like a rig that read_rig takes, whatever its name? False where it cannot be read.
bool is_rig_file(const std::string& path);

// Whether it has a mesh with a skin, which states which of its nodes are joints. InputErrors are those of read_rig, except a file without a
// mesh.
bool rig_has_skin(const std::string& path);

// The reader is chosen by the file's content. An InputError where the file is none of these formats, damaged or has no mesh.
Rig read_rig(const std::string& path);

}  // namespace pbs
