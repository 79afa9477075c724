// Which part of the skin an outline consists of. A plane through an arm that lies in the trunk cuts the skin of both, and the two may form
// one outline.
//   share_of_outline(outline, plane, positions, skin, of_the_arm);   // 0.1: most of the outline belongs to the trunk
#pragma once

#include "analysis/cross_section.hpp"

#include <vector>

namespace analysis {

// The share of the length of an outline, cut out of the skin by the plane, that lies on edges whose nearer vertex is one of `chosen`, #V.
// 1 for an outline without length.
double share_of_outline(const pbs::Positions& outline, const Plane& plane, const pbs::Positions& positions, const pbs::Triangles& skin,
                        const std::vector<bool>& chosen);

}  // namespace analysis
