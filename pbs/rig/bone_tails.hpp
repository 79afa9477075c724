// Where the bones of a rig end: a rig's file says only where its joints are.
#pragma once

#include "pbs/rig/rigged_body.hpp"

namespace pbs {

// Sets the tails of all bones of `body`, whose heads, surface and skin are known. A bone ends
// - at the joint below its own joint, whether that joint is a bone or not;
// - where several are below, in their middle, or at the one that moves most if they lie on opposite sides;
// - where none is below, at nine tenths of the way to the farthest point that it moves, in the direction of the middle of these points, or
//   of its parent if that middle is at the joint.
void set_tails(const Rig& rig, RiggedBody& body);

}  // namespace pbs
