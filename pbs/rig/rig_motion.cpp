#include "pbs/rig/rig_motion.hpp"

#include "pbs/rig/rig_pose.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr double slack_s = 1e-6;  // times given in decimal are not refused for their last digit

double rotation_between_deg(const Pose& a, const Pose& b)
{
    double largest = 0.0;
    for (std::size_t bone = 0; bone < a.size(); ++bone)
        largest = std::max(largest, Eigen::AngleAxisd(a[bone].linear().transpose() * b[bone].linear()).angle());
    return largest * 180.0 / M_PI;
}

}  // namespace

RigMotion rig_motion(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling)
{
    RigMotion made;
    made.motion.time_step_s = sampling.time_step_s;
    made.motion.steps_per_frame = steps_per_frame(sampling);
    const int frames = frames_after_the_first(sampling, animation.end_s - animation.start_s, slack_s, rig.file);
    for (int step = 0; step <= frames * made.motion.steps_per_frame; ++step) {
        const double time_s = animation.start_s + sampling.start_s + step * sampling.time_step_s;
        made.motion.steps.push_back(rigid_pose(body, node_transforms(rig, &animation, time_s), &made.stretch));
        made.largest_rotation_deg =
            std::max(made.largest_rotation_deg, rotation_between_deg(made.motion.steps.front(), made.motion.steps.back()));
    }
    return made;
}

Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling, int frame)
{
    const double time_s = animation.start_s + sampling.start_s + frame * steps_per_frame(sampling) * sampling.time_step_s;
    return artist_points(body, node_transforms(rig, &animation, time_s));
}

}  // namespace pbs
