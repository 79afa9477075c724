// Rigs from files: glTF 2.0 (.glb, .gltf) by tinygltf, FBX and COLLADA (.dae, .zae) by assimp, after a child process has tried.
//   const Rig rig = read_rig("hero.glb");
#pragma once

#include "pbs/rig/rig.hpp"
#include "pbs/skinning/weights.hpp"

#include <string>
#include <vector>

namespace pbs {

// Does the file's content look like a rig that read_rig takes, whatever its name? False where it cannot be read.
bool is_rig_file(const std::string& path);

// Whether it has a mesh with a skin, which states which of its nodes are joints. InputErrors are those of read_rig, except a file without a
// mesh.
bool rig_has_skin(const std::string& path);

// The reader is chosen by the file's content. An InputError where the file is none of these formats, damaged or has no mesh.
Rig read_rig(const std::string& path);

// The materials of the same file and their images, if they are in the file, below its folder or next to it.
RigMaterials read_materials(const std::string& path);

// Every index and number that the format does not guarantee, since damage may have led the library astray; an InputError where one is out
// of range. Rotations of nodes are returned with unit length, and animations with different names: the second of equal names is "NAME (2)".
Rig checked(Rig rig);

struct JointShare {
    int joint = 0;  // index into RigMesh::joints
    double weight = 0.0;
};

// The skin weights of a mesh, with sums of one. points: the shares of each point; one joint may occur several times, and its weights are
// added. Points whose weights are all zero follow joint 0, and sums that are not one within 1e-3 are counted: both are remarks. An
// InputError names a weight that is negative or not finite.
Weights normalised_skin(const std::vector<std::vector<JointShare>>& points, const std::string& file, const std::string& mesh,
                        std::vector<std::string>& remarks);

}  // namespace pbs
