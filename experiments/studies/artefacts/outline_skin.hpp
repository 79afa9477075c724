// Whose skin an outline is: a plane through an arm that lies in the trunk cuts the skin of both, and they may be one outline.
//   share_of_outline(outline, plane, positions, skin, of_the_arm);   // 0.1: the trunk's
#pragma once

#include "pbs/geometry/meshing.hpp"

#include <vector>

namespace experiments {

// Of the length of an outline that the plane cuts out of the skin: the share that lies on edges whose nearer vertex is one of `chosen`, #V.
// 1 of an outline without length.
double share_of_outline(const pbs::Positions& outline, const pbs::CuttingPlane& plane, const pbs::Positions& positions,
                        const pbs::Triangles& skin, const std::vector<bool>& chosen);

}  // namespace experiments
