// The motion that a scene asks for.
#pragma once

#include "experiments/scene/scene.hpp"
#include "pbs/character/clip.hpp"
#include "pbs/skinning/pose_path.hpp"

namespace experiments {

// A sweep or a clip on a skeleton. `scene_file` is named in errors.
pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);

// Any motion, with what looks wrong about it, a sentence each: a motion in which no bone turns, bones that the animation scales. An
// InputError if less than half of the clip's moving joints match and the scene does not allow it.
struct CaseMotion {
    pbs::Motion motion;
    std::vector<std::string> remarks;
    std::string partial_match;                // of a clip some of whose moving joints match no bone; empty: all do
    int clip_joints = 0, matched_joints = 0;  // of a clip: its joints that move, and those of them that move a bone
    double largest_rotation_deg = 0.0;        // of a bone, from the first frame to another one
};
CaseMotion make_case_motion(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file);

// The moving joints of a clip that move a bone of the skeleton. An InputError if there are none, or fewer than one half and the scene does
// not allow it.
pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton);

pbs::MotionSampling sampling_of(const MotionSpec& spec);

}  // namespace experiments
