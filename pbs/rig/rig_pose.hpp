// The pose of a rig at a time of an animation, and the skinning formula of its file format.
#pragma once

#include "pbs/rig/rig.hpp"

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

}  // namespace pbs
