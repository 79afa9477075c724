#include "pbs/rig/rig_motion.hpp"

#include "pbs/rig/rig_pose.hpp"

namespace pbs {
namespace {

constexpr double slack_s = 1e-6;  // times given in decimal are not refused for their last digit

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
    }
    return made;
}

Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling, int frame)
{
    const double time_s = animation.start_s + sampling.start_s + frame * steps_per_frame(sampling) * sampling.time_step_s;
    return artist_points(body, node_transforms(rig, &animation, time_s));
}

}  // namespace pbs
