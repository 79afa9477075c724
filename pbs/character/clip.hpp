// Motion capture clips (BVH, glTF, FBX, by assimp) and how they reach our skeletons.
#pragma once

#include "pbs/skinning/pose.hpp"

#include <string>
#include <vector>

namespace pbs {

// Joint rotations and root positions as the clip has them: `rotation[f][j]` global, rest directions from the zero pose.
struct Clip {
    std::string name;
    double frame_time_s = 0.0;
    std::vector<std::string> joints;
    std::vector<int> parent;                             // -1: root
    Positions zero_pose;                                 // joint positions of the zero pose [clip's units], #joints x 3
    std::vector<std::vector<Eigen::Quaterniond>> local;  // #frames x #joints
    Positions root;                                      // root position a frame [clip's units], #frames x 3
    int frames() const { return static_cast<int>(local.size()); }
};
Clip read_clip(const std::string& path);

// Retargets onto the `human` skeleton (CMU joint names) or, where the names of joints and bones agree, onto any; resamples.
struct ClipSampling {
    bool drop_first_frame = true;  // cgspeed's conversions begin with a T pose
    double start_s = 0.0;          // after the dropped frame
    double duration_s = 0.0;       // 0: to the end
    double rate_hz = 100.0;
    double time_step_s = 0.01;  // rate_hz * time_step_s = 1 / n: n steps a frame
};
Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling);

// Full path of a clip given by name: as it is, relative to `folder`, or in Debian's assimp-testmodels.
std::string find_clip(const std::string& name, const std::string& folder);

}  // namespace pbs
