// The skeleton in rest pose, one pose of it, a motion as a sequence of poses, the path from one pose to another, and
// the frames of a recorded motion.
//   const Motion bend = joint_sweep(skeleton, find_bone(skeleton, "forearm"), Vec3::UnitY(), 90.0, 37, 0.01);
//   for (const Pose& pose : bend.steps) linear_blend_skinning(rest, weights, pose, posed);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pbs {

// A bone of the skeleton in rest pose: the segment from its head to its tail, which moves rigidly with its joint at the
// head. Rest rotations are the identity (world axes). In skeletons from files each name is given once, bones have a
// length, and there is at least one root; those made by hand are not checked.
struct Bone {
    std::string name;  // what clips, weights files and find_bone know it by
    int parent = -1;   // index into Skeleton::bones, -1 for a root; parents precede their children
    Vec3 head;         // s_j [m]
    Vec3 tail;         // d_j [m]
    // as the file's own table calls it (VRM: leftUpperArm), whatever its name; empty: it is in none
    std::string body_part = {};
};

// The order of bones is that of a Pose's transforms and of the indices in weights and bindings.
struct Skeleton {
    std::vector<Bone> bones;  // parents before their children
};

int find_bone(const Skeleton& skeleton, const std::string& name);  // -1 where there is none

// Bones that meet at an end of bone j (Eq. 2's n_joints, which the paper does not define: it is read as this), j itself
// first. At the head: the parent (wherever it ends), and siblings and children that start there; at the tail: the
// children that start there. "There" is within 2 % of the skeleton's bounding diagonal.
enum class BoneEnd { head, tail };
// Indices into Skeleton::bones; `bone` is one of them (unchecked).
std::vector<int> bones_meeting(const Skeleton& skeleton, int bone, BoneEnd end);

// P_j R_j^-1 of Eq. 1 for each bone: the rigid transform that carries a rest point [m] to its place in the pose,
// #bones. (The paper calls them rotation matrices; they have to be rigid transforms.)
using Pose = std::vector<Eigen::Isometry3d>;

// Poses one time step apart; every `steps_per_frame`-th is a frame, the first and the last included.
struct Motion {
    std::vector<Pose> steps;             // every pose, the substeps between frames included
    double time_step_s = 0.01;           // Delta t of Algorithm 1
    int steps_per_frame = 1;             // 1 or more
    std::vector<double> angle_deg = {};  // of a sweep, one per frame; empty for a clip

    // Whole frames; 0 where there is no step.
    int frames() const { return steps.empty() ? 0 : static_cast<int>((steps.size() - 1) / steps_per_frame) + 1; }
};

// The first bone with which each bone moves as one in all poses, #bones. Two bones move as one if they move every point
// within size_m of the mean joint to the same place, up to 1e-3 size_m.
std::vector<int> bones_that_move_as_one(const Skeleton& skeleton, const std::vector<Pose>& poses, double size_m);

// Pose from local joint rotations about the heads (parent's frame = world axes) and a translation [m] of the roots.
// local_rotations: one per bone, of any non-zero length (#bones, unchecked). Parents precede their children.
Pose pose_from_joints(const Skeleton& skeleton, const std::vector<Eigen::Quaterniond>& local_rotations,
                      const Vec3& root_translation);

// A joint sweep: frame i of `frames` turns `joint` by angle_deg * i / (frames - 1) about `axis` (rest world axes);
// frame 0 is the rest pose. InputError where `joint` is no bone of the skeleton, `axis` is zero or not finite, or
// `frames` is below 1.
Motion joint_sweep(const Skeleton& skeleton, int joint, const Vec3& axis, double angle_deg, int frames,
                   double time_step_s);

// A path from one pose to another on which joints stay joined: each bone turns relative to its parent at an even rate,
// the short way round (slerp), and its head moves in a straight line relative to its parent. Roots turn and move in the
// world in the same way.
//   const PosePath path(skeleton, from, to);
//   path.at(0.5);
class PosePath {
public:
    PosePath(const Skeleton& skeleton, const Pose& from, const Pose& to);

    Pose at(double fraction) const;   // 0: from, 1: to
    double largest_turn_deg() const;  // between the ends, of any bone

private:
    struct Joint {
        Eigen::Quaterniond rotation;  // relative to the parent
        Vec3 head;                    // its place in the parent's rest coordinates [m]
    };
    std::vector<Joint> joints_of(const Pose& pose) const;

    Skeleton skeleton_;
    Pose from_, to_;
    std::vector<Joint> start_, end_;
};

// A pose relative to its root bone, and back: the rigid motion of the whole body is removed before a quasi-static solve
// and applied after it. This is exact for every material law that is invariant under a rigid motion, and a linear law
// must not see any.
class RootFrame {
public:
    RootFrame(const Skeleton& skeleton, const Pose& pose);

    const Pose& pose() const { return pose_; }               // relative to the root
    const Eigen::Isometry3d& root() const { return root_; }  // the root in the world
    Vec3 from_world(const Vec3& direction) const { return root_.linear().transpose() * direction; }
    Positions to_world(const Positions& points) const;  // [m], #points x 3
    Positions to_root(const Positions& points) const;   // its inverse

private:
    Eigen::Isometry3d root_;
    Pose pose_;
};

// The stretch of a recorded motion that is taken, and the frames and time steps that are made of it.
struct MotionSampling {
    double start_s = 0.0;
    double duration_s = 0.0;    // 0: to the end
    double rate_hz = 100.0;     // frames per second of the motion that is made, whatever the recorded rate
    double time_step_s = 0.01;  // of Algorithm 1; rate_hz * time_step_s = 1 / n: n steps per frame
};

// n. InputErrors: a rate or a time step that is not positive; a product of the two that is not 1 / n with n from 1 to
// 100,000.
int steps_per_frame(const MotionSampling& sampling);

// The number of frames after the first one in a recording that lasts length_s. The stretch may reach beyond the
// recording by slack_s, for rounding. An InputError names `file`.
int frames_after_the_first(const MotionSampling& sampling, double length_s, double slack_s, const std::string& file);

// The longest time step [s] of at most longest_s that divides a frame into whole steps.
double time_step_for(double rate_hz, double longest_s = 0.01);

}  // namespace pbs
