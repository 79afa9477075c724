// A rig made ready for skinning: its skeleton in the bind pose, the artist's surface and the artist's weights.
//   const Rig rig = read_rig("hero.glb");
//   const RiggedBody body = make_rigged_body(rig, find_animation(rig, "Walk"), 1.0);
#pragma once

#include "pbs/rig/rig_pose.hpp"
#include "pbs/skinning/pose.hpp"

namespace pbs {

// A joint of the file that is no bone here, and why.
struct DroppedJoint {
    std::string name, reason;
};

struct RiggedBody {
    RigBinding binding;
    Skeleton skeleton;                    // the joints that move points; empty for a file without joints and animations, [m]
    std::vector<int> node;                // of each bone, index into Rig::nodes, #bones
    Positions surface;                    // the points of all moved meshes in rest space [m], #P x 3
    Triangles triangles;                  // of them, #F x 3
    Weights skin;                         // the artist's weights of the points in bones, #P; not read without bones
    std::vector<DroppedJoint> dropped;    // joints without weight
    std::vector<std::string> containers;  // nodes above joints that are no joints: they contribute their transforms
    double bind_pose_deg = 0.0;           // the largest rotation of a bone from the bind pose to the file's rest pose
    std::vector<std::string> remarks;     // of the reader and of what was made of the rig
};

// A joint that moves points is a bone, from the joint to where the joints below it are (Tails in rigged_body.cpp); its parent is the next
// such joint above it. Bones are named as the joints; a name that occurs twice gets a number.
RiggedBody make_rigged_body(const Rig& rig, const RigAnimation* animation, double scale);

// The surface as the artist's own skinning moves it: the format's formula with scale and shear, [m], #P x 3.
Positions artist_points(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms);

// The rigid part of every bone's motion from rest. stretch: the largest relative change of a length that is lost with the rest, if wanted.
Pose rigid_pose(const RiggedBody& body, const std::vector<Eigen::Affine3d>& node_transforms, double* stretch = nullptr);

// An animation of a rig as a motion of its bones.
struct RigMotion {
    Motion motion;
    double stretch = 0.0;  // the largest relative change of a length in a bone's transform, which is left out
};

// sampling.start_s is after the first key of the animation. InputErrors are those of pose.hpp.
RigMotion rig_motion(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling);

// The artist's surface at a frame of that motion [m], #P x 3.
Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling, int frame);

}  // namespace pbs
