// A path from one pose to another on which joints stay joined: each bone turns relative to its parent at an even rate, the short way round
// (slerp), and its head moves in a straight line relative to its parent. Roots turn and move in the world in the same way.
//   const PosePath path(skeleton, from, to);
//   path.at(0.5);
#pragma once

#include "pbs/skinning/pose.hpp"

#include <string>

namespace pbs {

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

// A pose relative to its root bone, and back: the rigid motion of the whole body is removed before a quasi-static solve and applied after
// it. This is exact for every material law that is invariant under a rigid motion, and a linear law must not see any.
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

// n. InputErrors: a rate or a time step that is not positive; a product of the two that is not 1 / n with n from 1 to 100,000.
int steps_per_frame(const MotionSampling& sampling);

// The number of frames after the first one in a recording that lasts length_s. The stretch may reach beyond the recording by slack_s, for
// rounding. An InputError names `file`.
int frames_after_the_first(const MotionSampling& sampling, double length_s, double slack_s, const std::string& file);

// The longest time step [s] of at most longest_s that divides a frame into whole steps.
double time_step_for(double rate_hz, double longest_s = 0.01);

}  // namespace pbs
