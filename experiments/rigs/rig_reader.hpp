// Rigs from files: glTF 2.0 (.glb, .gltf) by tinygltf, FBX by its own reader, COLLADA (.dae, .zae) by assimp, after a
// child process has tried.
//   const Rig rig = read_rig("hero.glb");
#pragma once

#include "experiments/rigs/rig.hpp"
#include "pbs/skinning/weights.hpp"

#include <string>
#include <vector>

namespace pbs {

// Does the file's content look like a rig that read_rig takes, whatever its name? False where it cannot be read.
bool is_rig_file(const std::string& path);

// Whether it has a mesh with a skin, which states which of its nodes are joints. InputErrors are those of read_rig,
// except a file without a mesh.
bool rig_has_skin(const std::string& path);

// The reader is chosen by the file's content. The surfaces have neither second sides nor points without a triangle. An
// InputError where the file is none of these formats, damaged or has no mesh.
Rig read_rig(const std::string& path);

// With or without a mesh: a clip may be a skeleton alone.
Rig read_any_rig(const std::string& path);

// The materials of the same file and their images, if they are in the file, below its folder or next to it.
RigMaterials read_materials(const std::string& path);

// Every index and number that the format does not guarantee, since damage may have led the library astray; an
// InputError where one is out of range. Rotations of nodes are returned with unit length, and animations with different
// names: the second of equal names is "NAME (2)".
Rig checked(Rig rig);

struct JointShare {
    int joint = 0;  // index into RigMesh::joints
    double weight = 0.0;
};

// The shares of each point of a mesh, of which up to 1 % may have a weight that is no finite number: these take the
// mean weights of their neighbours, points at one place that of each other, which is a remark. mesh: its name, points
// and triangles. An InputError where there are more, or where a point has no neighbour with weights.
std::vector<std::vector<JointShare>> with_weights_of_neighbours(std::vector<std::vector<JointShare>> points,
                                                                const RigMesh& mesh, const std::string& file,
                                                                std::vector<std::string>& remarks);

// Leaves out, with a remark each, what is no part of the surface of a mesh: the second side of a shell, which has each
// triangle once more with its corners in the reverse order, and points that no triangle uses. A sheet keeps both sides,
// which enclose nothing.
void leave_out_second_sides_and_unused_points(Rig& rig);

// The skin weights of a mesh, with sums of one. points: the shares of each point; one joint may occur several times,
// and its weights are added. Points whose weights are all zero follow joint 0, which is a remark, and sums that are not
// one within 1e-3 are counted, which is a note. An InputError names a weight that is negative or not finite.
Weights normalised_skin(const std::vector<std::vector<JointShare>>& points, const std::string& file,
                        const std::string& mesh, std::vector<std::string>& remarks, std::vector<std::string>& notes);

}  // namespace pbs
