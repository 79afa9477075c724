// A rig made ready for skinning: its skeleton in the bind pose, the artist's surface and the artist's weights.
//   const Rig rig = read_rig("hero.glb");
//   const RiggedBody body = make_rigged_body(rig, find_animation(rig, "Walk"), 1.0);
#pragma once

#include "experiments/rigs/rig.hpp"
#include "pbs/skinning/pose.hpp"

#include <map>

namespace pbs {

// These functions pose a rig at a time of an animation, and move its mesh by the skinning formula of its file format.

// From the coordinates of each node to those of the file's scene, #nodes. animation null: at rest. Before the first key
// and after the last one a property keeps that key's value.
std::vector<Eigen::Affine3d> node_transforms(const Rig& rig, const RigAnimation* animation, double time_s);

// The value of a track at a time, as the format interpolates it; a quaternion has unit length.
Vec3 vector_at(const KeyTrack& track, double time_s);
Eigen::Quaterniond rotation_at(const KeyTrack& track, double time_s);

// The format's skinning formula: sum_j w_j W_j B_j^-1 v with the joints' transforms W_j in the scene and their inverse
// bind matrices B_j^-1; W_node v of a mesh without a skin. Where RigMesh::dual_quaternion_share is above 0, the same by
// dual quaternion linear blending of the rotations and translations, with the scales of the sum, to that share. #P x 3,
// in the scene's coordinates and the file's unit.
Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms);
Positions skinned_points(const RigMesh& mesh, const std::vector<Eigen::Affine3d>& node_transforms,
                         const Positions& points);

// The mesh's points with its morph targets at a time of the animation, before its skin moves them: #P x 3, in the
// mesh's coordinates and the file's unit. animation null: at rest.
Positions morphed_points(const RigMesh& mesh, const RigAnimation* animation, double time_s);

// How the meshes of a rig are attached to its nodes in the bind pose: the joints that move them, and one rest space for
// all of them. That is the file's scene in the bind pose, in metres: where the root joint of the largest skin is at
// rest, the bind pose is attached to it. B_j carries the frame of joint j into it.
struct RigBinding {
    // those that joints move; one without a skin follows the joint above it with weight 1
    std::vector<RigMesh> meshes;
    std::map<int, Eigen::Affine3d> bind;  // node of each joint of these meshes -> B_j [m]
    double metres_per_unit = 1.0;         // of the posed scene
    // meshes that no joint moves and that were left out, bind poses that contradict each other
    std::vector<std::string> remarks;
};

// scale: further metres per metre of the file, for files that state a wrong unit. animation: null for none; its first
// pose determines the size, for animations may scale the root. Meshes without any joint in the whole file are kept, at
// rest.
RigBinding bind_rig(const Rig& rig, const RigAnimation* animation, double scale);

// The points of a mesh in rest space: sum_j w_j B_j B_mesh,j^-1 v [m], #P x 3.
Positions rest_points(const RigMesh& mesh, const RigBinding& binding);

// A joint of the file that is no bone here, and why.
struct DroppedJoint {
    std::string name, reason;
};

struct RiggedBody {
    RigBinding binding;
    Skeleton skeleton;      // the joints that move points; empty for a file without joints and animations, [m]
    std::vector<int> node;  // of each bone, index into Rig::nodes, #bones
    Positions surface;      // the points of all moved meshes in rest space [m], #P x 3
    Triangles triangles;    // of them, #F x 3
    RigLook look;           // of both; normals are those of the file
    Weights skin;           // the artist's weights of the points in bones, #P; not read without bones
    std::vector<DroppedJoint> dropped;    // joints without weight
    std::vector<std::string> containers;  // nodes above joints that are no joints: they contribute their transforms
    double bind_pose_deg = 0.0;           // the largest rotation of a bone from the bind pose to the file's rest pose
    std::vector<std::string> remarks;     // of the reader and of what was made of the rig
    std::vector<std::string> notes;       // of both, where nothing is missing
};

// A joint that moves points is a bone, from the joint to where the joints below it are (Tails in rigged_body.cpp); its
// parent is the next such joint above it. Bones are named as the joints; a name that occurs twice gets a number.
RiggedBody make_rigged_body(const Rig& rig, const RigAnimation* animation, double scale);

// The surface as the artist's own skinning moves it: the format's formula with scale and shear, [m], #P x 3. With an
// animation, also its morph targets at that time.
Positions artist_points(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms,
                        const RigAnimation* animation = nullptr, double time_s = 0.0);

// The same for a pose of the skeleton, whose bones move rigidly: each joint with weight follows its bone.
Positions artist_points(const RiggedBody& body, const Pose& pose);

// The rigid part of every bone's motion from rest. stretch: the largest relative change of a length that is lost with
// the rest, if wanted.
Pose rigid_pose(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms, double* stretch = nullptr);

// Where an animation moves a bone farthest from its parent, or closest to it, in comparison with the bind pose. The
// distance is measured along the joints between the two, so that no rotation changes it.
struct DistanceChange {
    double relative = 0.0;  // 0.5: half as far again as in the bind pose
    double change_m = 0.0;
    int frame = 0;
};

// An animation of a rig as a motion of its bones.
struct RigMotion {
    Motion motion;
    double stretch = 0.0;  // the largest relative change of a length in a bone's transform, which is left out
    std::vector<DistanceChange> distances = {};  // of each bone from its parent, #bones; zero of a root
};

// sampling.start_s is after the first key of the animation. InputErrors are those of pose.hpp.
RigMotion rig_motion(const Rig& rig, const RiggedBody& body, const RigAnimation& animation,
                     const MotionSampling& sampling);

// The artist's surface at a frame of that motion [m], #P x 3.
Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation,
                       const MotionSampling& sampling, int frame);

}  // namespace pbs
