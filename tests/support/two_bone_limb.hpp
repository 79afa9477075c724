// A bar with two bones along x that meet at the origin, bent or twisted there: all inputs of a solver step, without
// files.
//   const TwoBoneLimb limb = two_bone_limb({24, 4, 4}, {0, 0, 1}, 90.0);
#pragma once

#include "pbs/skinning/blend.hpp"
#include "tests/support/structured_bar.hpp"

namespace test_support {

struct TwoBoneLimb {
    pbs::TetMesh mesh;
    pbs::Skeleton skeleton;
    pbs::BoneBinding binding;
    pbs::Weights weights;
    pbs::Pose pose;
    pbs::Positions lbs;          // LBS positions [m], #V x 3
    pbs::Positions bind_points;  // q_i [m], #V x 3
};

inline void pose_limb(TwoBoneLimb& limb, const pbs::Pose& pose)
{
    limb.pose = pose;
    pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, limb.pose, limb.lbs);
    limb.bind_points = pbs::posed_bind_points(limb.binding, limb.pose);
}

// Any mesh around the x axis from joint - 1 m to joint + 1 m, at rest.
inline TwoBoneLimb two_bones_in(pbs::TetMesh mesh, const pbs::Vec3& joint = pbs::Vec3::Zero())
{
    const pbs::Vec3 along(1.0, 0.0, 0.0);
    TwoBoneLimb limb;
    limb.mesh = std::move(mesh);
    limb.skeleton.bones = {{"upper", -1, joint - along, joint}, {"forearm", 0, joint, joint + along}};
    limb.binding = pbs::bind_to_nearest_bone(limb.mesh.rest, limb.skeleton);
    limb.weights = pbs::paper_weights(limb.binding, limb.skeleton);
    pose_limb(limb, pbs::Pose(2, Eigen::Isometry3d::Identity()));
    return limb;
}

inline TwoBoneLimb two_bone_limb(const std::array<int, 3>& cells, const pbs::Vec3& axis, double angle_deg,
                                 const pbs::Vec3& joint = pbs::Vec3::Zero())
{
    const pbs::Vec3 half(1.0, 0.15, 0.15);
    TwoBoneLimb limb = two_bones_in(structured_bar(joint - half, joint + half, cells), joint);
    pose_limb(limb, pbs::joint_sweep(limb.skeleton, 1, axis, angle_deg, 2, 0.01).steps.back());
    return limb;
}

}  // namespace test_support
