// The pose of a rig at a time of an animation, and the skinning formula of its file format.
#pragma once

#include "pbs/rig/rig.hpp"

#include <map>

namespace pbs {

// From the coordinates of each node to those of the file's scene, #nodes. animation null: at rest. Before the first key and after the last
// one a property keeps that key's value.
std::vector<Eigen::Affine3d> node_transforms(const Rig& rig, const RigAnimation* animation, double time_s);

// The value of a track at a time, as the format interpolates it; a quaternion has unit length.
Vec3 vector_at(const KeyTrack& track, double time_s);
Eigen::Quaterniond rotation_at(const KeyTrack& track, double time_s);

// The format's skinning formula: sum_j w_j W_j B_j^-1 v with the joints' transforms W_j in the scene and their inverse bind matrices
// B_j^-1; W_node v of a mesh without a skin. #P x 3, in the scene's coordinates and the file's unit.
Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms);

// How the meshes of a rig are attached to its nodes in the bind pose: the joints that move them, and one rest space for all of them. That
// is the file's scene in the bind pose, in metres: where the root joint of the largest skin is at rest, the bind pose is attached to it.
// B_j carries the frame of joint j into it.
struct RigBinding {
    std::vector<RigMesh> meshes;          // those that joints move; one without a skin follows the joint above it with weight 1
    std::map<int, Eigen::Affine3d> bind;  // node of each joint of these meshes -> B_j [m]
    double metres_per_unit = 1.0;         // of the posed scene
    std::vector<std::string> remarks;     // meshes that no joint moves and that were left out, bind poses that contradict each other
};

// scale: further metres per metre of the file, for files that state a wrong unit. animation: null for none; its first pose determines the
// size, for animations may scale the root. Meshes without any joint in the whole file are kept, at rest.
RigBinding bind_rig(const Rig& rig, const RigAnimation* animation, double scale);

// The points of a mesh in rest space: sum_j w_j B_j B_mesh,j^-1 v [m], #P x 3.
Positions rest_points(const RigMesh& mesh, const RigBinding& binding);

}  // namespace pbs
