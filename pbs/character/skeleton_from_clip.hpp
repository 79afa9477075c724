// The skeleton that a clip's file (BVH, glTF, FBX) carries: its joints in the zero pose.
//   const Skeleton skeleton = skeleton_from_clip(read_clip("01_01.bvh"), 0.0254 / 0.45);   // CMU's unit in metres
#pragma once

#include "pbs/character/clip.hpp"

namespace pbs {

// A bone runs from each joint to its first child that lies elsewhere; joints without one (ends, and joints that coincide with their child)
// have none, and what is attached to them is attached to the next bone above. scale: metres per unit of the clip. InputError where no bone
// is left.
Skeleton skeleton_from_clip(const Clip& clip, double scale);

}  // namespace pbs
