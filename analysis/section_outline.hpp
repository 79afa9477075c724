// The thickness of a limb in a plane: area and radii of the outline that the plane cuts out of its skin.
//   const pbs::Positions* outline = enclosing_outline(outlines, {axis_point, axis_direction});
//   const OutlineSize size = outline_size(*outline);   // size.smallest_radius_m near zero: a candy wrapper
// Outlines are closed lines in a plane, points [m], #P x 3, the first not repeated at its end.
#pragma once

#include "analysis/cross_section.hpp"

#include <vector>

namespace analysis {

// Radii are distances from the centroid of the outline (weighted by length), so that flesh that is displaced as a whole does not count as
// thinner.
struct OutlineSize {
    double area_m2 = 0.0;  // enclosed area; where the outline crosses itself, parts that run clockwise are subtracted
    double smallest_radius_m = 0.0, largest_radius_m = 0.0;  // to the nearest point of a side; to the farthest corner
};
OutlineSize outline_size(const pbs::Positions& outline);  // all 0 without points

// How many times the outline winds around the plane's point; 0: the point lies outside.
int winding_number(const pbs::Positions& outline, const Plane& plane);

// The outline of the limb whose axis meets the plane in the plane's point: the tightest of the outlines that enclose that point or, if none
// does (a collapsed limb), the nearest one. Null without outlines.
const pbs::Positions* enclosing_outline(const std::vector<pbs::Positions>& outlines, const Plane& plane);

}  // namespace analysis
