// An animation of a rig as a motion of its bones.
#pragma once

#include "pbs/rig/rigged_body.hpp"
#include "pbs/skinning/pose_path.hpp"

namespace pbs {

struct RigMotion {
    Motion motion;
    double stretch = 0.0;  // the largest relative change of a length in a bone's transform, which is left out
};

// sampling.start_s is after the first key of the animation. InputErrors are those of pose_path.hpp.
RigMotion rig_motion(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling);

// The artist's surface at a frame of that motion [m], #P x 3.
Positions artist_frame(const Rig& rig, const RiggedBody& body, const RigAnimation& animation, const MotionSampling& sampling, int frame);

}  // namespace pbs
